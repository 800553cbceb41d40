"""What annotators see: the run in use, their own numbers, and what they refused."""

from __future__ import annotations

import pytest

from gtm_hit.models import Annotation, Assignment, Dataset, Frame, Layer, Refusal
from gtm_hit.ops.frames.neighbours import Neighbours, neighbours
from gtm_hit.ops.proposals import layers, refusals, runs
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.proposals.proposing import propose
from gtm_hit.ops.proposals.reading import for_layer
from gtm_hit.ops.work import assignments, batches
from gtm_hit.ops.work.assignments import ReadOnly
from tests.ops.proposals.conftest import NUMBERS
from tests.ops.proposals.watcher import Watcher, make_run, person, shown_run, two_walkers, walk
from tests.work_scene import do_frames, finish, make_layer, make_worker, row, save


@pytest.fixture
def walked(dataset: Dataset) -> Dataset:
    """Two who walk by, proposed and shown."""
    shown_run(dataset, two_walkers(NUMBERS))
    return dataset


def frames(dataset: Dataset) -> list[Frame]:
    return list(dataset.frames.order_by("number"))


def test_the_run_in_use_is_shown_the_likeliest_first(walked: Dataset) -> None:
    shown = for_layer(make_layer(walked), frames(walked), Neighbours())
    assert [frame.number for frame in shown.frames] == list(NUMBERS)
    assert all(len(frame.people) == 2 for frame in shown.frames)
    assert all(one.person is None and 0 < one.doubt < 0.5 for one in shown.frames[0].people)
    assert Annotation.objects.count() == 0


def test_nothing_is_shown_where_no_run_is_in_use(walked: Dataset) -> None:
    runs.use_none(walked)
    assert for_layer(make_layer(walked), frames(walked), Neighbours()).frames == []


def test_a_track_has_the_number_of_whom_somebody_marked_there(walked: Dataset) -> None:
    layer = make_layer(walked)
    place = int(walked.grid.position([(0.1, 0.05)])[0])
    save(layer, frames(walked)[0], [row(person=31, position=place)])
    shown = for_layer(layer, frames(walked), Neighbours())
    assert {one.person for frame in shown.frames for one in frame.people} == {31, None}
    assert all(one.person in {31, None} for one in shown.frames[7].people)


def test_accepted_neighbours_keep_their_numbers(walked: Dataset) -> None:
    batches.make_batches(walked, size=4)
    first = assignments.claim(make_worker(), walked)
    places = walked.grid.position([(0.3 * at, 0.0) for at in range(4)]).tolist()
    for at, place in enumerate(places):
        save(first.layer, frames(walked)[at], [row(person=44, position=place)], author=first.worker)
    finish(first)
    Assignment.objects.filter(pk=first.pk).update(state="accepted")
    second = assignments.claim(make_worker("two"), walked)
    own = list(Frame.objects.filter(batches=second.batch_id).order_by("number"))
    shown = for_layer(second.layer, own, neighbours(second.batch))
    persons = [sorted(one.person or 0 for one in frame.people) for frame in shown.frames]
    assert persons == [[0, 44]] * 4


def test_a_refusal_is_remembered_and_taken_back(walked: Dataset) -> None:
    layer, frame = make_layer(walked), frames(walked)[0]
    refusals.refuse(layer, frame, 500, None)
    refusals.refuse(layer, frame, 500, None)
    assert for_layer(layer, [frame], Neighbours()).frames[0].refused == [500]
    refusals.refuse(layer, frame, 500, None, refused=False)
    assert Refusal.objects.count() == 0


def test_a_refusal_off_the_grid_is_none(walked: Dataset) -> None:
    with pytest.raises(ProposalError, match="not on the grid"):
        refusals.refuse(make_layer(walked), frames(walked)[0], 10**9, None)


def test_a_worker_refuses_in_his_own_batch_only_while_he_holds_it(walked: Dataset) -> None:
    batches.make_batches(walked, size=8)
    mine = assignments.claim(make_worker(), walked)
    frame = frames(walked)[0]
    refusals.refuse(mine.layer, frame, 7, mine.worker)
    assert Refusal.objects.get().worker == mine.worker
    with pytest.raises(ReadOnly):
        refusals.refuse(mine.layer, frame, 8, make_worker("other"))
    do_frames(mine)
    assignments.submit(mine)
    with pytest.raises(ReadOnly):
        refusals.refuse(mine.layer, frame, 8, mine.worker)


def test_a_run_becomes_a_layer_that_says_where_it_comes_from(walked: Dataset) -> None:
    made = layers.make_layer(runs.runs(walked)[0], "by-program")
    assert made.kind == Layer.Kind.PROPOSAL
    assert Annotation.objects.filter(layer=made).count() == 16
    assert set(Annotation.objects.values_list("origin", flat=True)) == {"proposed"}
    assert set(Annotation.objects.values_list("person", flat=True)) == {1, 2}


def test_a_layer_has_only_whom_the_score_says(dataset: Dataset) -> None:
    run = make_run(dataset)
    propose(run, Watcher(dataset, {0: [person(0, 0, 0.9), person(3, 3, 0.4)]}))
    made = layers.make_layer(run, "sure", threshold=0.5)
    assert Annotation.objects.filter(layer=made).count() == 1
    assert made.layer_frames.filter(done=True).count() == 8


def test_somebody_no_other_frame_confirms_needs_a_higher_score(dataset: Dataset) -> None:
    run = make_run(dataset)
    people = {**walk(NUMBERS), 0: [person(0, 0, 0.6), person(3, 3, 0.6), person(-3, 3, 0.8)]}
    propose(run, Watcher(dataset, people))
    made = layers.make_layer(run, "sure")
    assert Annotation.objects.filter(layer=made, frame__number=0).count() == 2


def test_a_name_that_is_taken_makes_no_layer(walked: Dataset) -> None:
    make_layer(walked, "taken")
    for name in ("taken", "no spaces", ""):
        with pytest.raises(ProposalError):
            layers.make_layer(runs.runs(walked)[0], name)
    assert Layer.with_unfinished.count() == 1
