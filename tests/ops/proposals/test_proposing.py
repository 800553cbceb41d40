"""Frames are looked at once, whatever happens in between."""

from __future__ import annotations

import pytest

from gtm_hit.models import Dataset, Frame, Image, Proposal, ProposalFrame
from gtm_hit.ops.proposals import runs
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.proposals.proposing import propose
from tests.ops.proposals.conftest import NUMBERS, store
from tests.ops.proposals.watcher import Watcher, make_run, person, walk
from tests.work_scene import add_frames


class PowerCut(Exception):
    pass


def proposed(dataset: Dataset) -> list[tuple[int, int, int | None]]:
    rows = Proposal.objects.filter(proposal_frame__run__dataset=dataset)
    found = rows.order_by("proposal_frame__frame__number", "x")
    return list(found.values_list("proposal_frame__frame__number", "position", "track"))


def test_every_frame_is_looked_at_and_everybody_gets_a_track(dataset: Dataset) -> None:
    found = propose(make_run(dataset), Watcher(dataset, walk(NUMBERS)))
    assert (found.frames, found.known, found.people, found.tracks) == (8, 0, 8, 1)
    assert [number for number, _position, _track in proposed(dataset)] == list(NUMBERS)
    assert {track for _number, _position, track in proposed(dataset)} == {1}


def test_a_second_time_nothing_is_looked_at(dataset: Dataset) -> None:
    run, watcher = make_run(dataset), Watcher(dataset, walk(NUMBERS))
    propose(run, watcher)
    before = proposed(dataset)
    watcher.looked.clear()
    assert propose(run, watcher).known == 8
    assert watcher.looked == []
    assert proposed(dataset) == before


def test_after_a_power_cut_the_rest_is_looked_at_and_nothing_twice(dataset: Dataset) -> None:
    run, watcher = make_run(dataset), Watcher(dataset, walk(NUMBERS))

    def cut(number: int) -> None:
        if number == 20:
            raise PowerCut

    watcher.before = cut
    with pytest.raises(PowerCut):
        propose(run, watcher)
    assert watcher.looked == [0, 5, 10, 15]
    again = Watcher(dataset, walk(NUMBERS))
    propose(run, again)
    assert again.looked == [20, 25, 30, 35]
    assert len(proposed(dataset)) == 8


def test_a_frame_whose_picture_changed_is_looked_at_again(dataset: Dataset) -> None:
    run = make_run(dataset)
    propose(run, Watcher(dataset, walk(NUMBERS)))
    store(Image.objects.filter(frame__number=10)[0], shade=90)
    watcher = Watcher(dataset, walk(NUMBERS))
    propose(run, watcher)
    assert watcher.looked == [10]
    assert len(proposed(dataset)) == 8


def test_frames_that_arrive_meanwhile_are_looked_at_too(dataset: Dataset) -> None:
    watcher = Watcher(dataset, walk(NUMBERS))
    watcher.numbers = {}

    def arrive(number: int) -> None:
        if not watcher.looked and not Frame.objects.filter(number=40).exists():
            for image in Image.objects.filter(frame__in=add_frames(dataset, 1, images=True)):
                store(image)
            watcher.numbers = Watcher(dataset, {}).numbers

    watcher.numbers = Watcher(dataset, {}).numbers
    watcher.before = arrive
    assert propose(make_run(dataset), watcher).frames == 9
    assert watcher.looked == [*NUMBERS, 40]


def test_a_hole_of_one_frame_is_filled_and_says_so(dataset: Dataset) -> None:
    people = walk(NUMBERS)
    people[15] = []
    propose(make_run(dataset), Watcher(dataset, people))
    filled = Proposal.objects.get(filled=True)
    assert filled.proposal_frame.frame.number == 15
    assert filled.x == pytest.approx(0.9)
    assert filled.evidence == []


def test_nobody_outside_the_grid_is_proposed(dataset: Dataset) -> None:
    propose(make_run(dataset), Watcher(dataset, {0: [person(40.0, 0.0), person(1.0, 1.0)]}))
    assert Proposal.objects.count() == 1


def test_evidence_and_alarms_are_kept(dataset: Dataset) -> None:
    propose(make_run(dataset), Watcher(dataset, walk(NUMBERS), alarms=["C2"]))
    first = Proposal.objects.first()
    assert first is not None
    assert first.evidence[0] == {"camera": "C1", "box": [10, 20, 30, 80], "seen": 0.8, "hidden": False}
    assert first.evidence[1]["seen"] is None
    frame = ProposalFrame.objects.first()
    assert frame is not None
    assert frame.suspicious == [{"camera": "C2", "metres": 3.0, "why": "it stands elsewhere"}]
    assert runs.summaries(dataset)[0].alarms == {"C2": 8}


def test_a_dataset_without_pictures_says_so(dataset: Dataset) -> None:
    Image.objects.all().delete()
    with pytest.raises(ProposalError, match="no pictures"):
        propose(make_run(dataset), Watcher(dataset, {}))


def test_the_same_values_are_the_same_run_and_others_another(dataset: Dataset) -> None:
    assert make_run(dataset) == make_run(dataset)
    assert make_run(dataset, threshold=1) != make_run(dataset)


def test_another_calibration_is_another_run_and_hides_the_old_one(dataset: Dataset) -> None:
    run = make_run(dataset)
    runs.use(run)
    assert runs.in_use(dataset) == run
    camera = dataset.cameras.all()[0]
    camera.tvec = [0.0, 1.0, 12.5]
    camera.save()
    fresh = Dataset.objects.get(pk=dataset.pk)
    assert runs.in_use(fresh) is None
    assert make_run(fresh) != run


def test_one_run_is_in_use_at_a_time(dataset: Dataset) -> None:
    first, second = make_run(dataset), make_run(dataset, method="pom")
    runs.use(first)
    runs.use(second)
    assert runs.in_use(dataset) == second
    runs.use_none(dataset)
    assert runs.in_use(dataset) is None
