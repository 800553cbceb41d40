"""Who is missing in a layer of the database."""

from __future__ import annotations

import pytest

from gtm_hit.models import Annotation, Dataset, Layer, PictureBoxes, Refusal
from gtm_hit.ops.proposals import layers, missing, runs
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.proposals.pictures import pictures_of
from gtm_hit.ops.work import assignments, batches
from gtm_hit.vision.missing import Why
from tests.ops.proposals.conftest import NUMBERS
from tests.ops.proposals.watcher import Watcher, shown_run, two_walkers
from tests.work_scene import make_layer, make_worker, row, save


@pytest.fixture
def finished(dataset: Dataset) -> Layer:
    """Two walkers, annotated exactly where they are proposed."""
    return layers.make_layer(shown_run(dataset, two_walkers(NUMBERS)), "finished")


def take_out(layer: Layer, number: int, person: int) -> int:
    """The position the person had."""
    frame = layer.dataset.frames.get(number=number)
    people = list(Annotation.objects.filter(layer=layer, frame=frame))
    kept = [row(one.person, one.position) for one in people if one.person != person]
    save(layer, frame, kept, revision=1, done=True)
    return next(one.position for one in people if one.person == person)


def test_a_finished_layer_has_nobody_missing(finished: Layer) -> None:
    report = missing.missing(finished)
    assert (report.frames, report.later, report.places) == (8, 0, [])


def test_somebody_taken_out_is_listed_and_can_be_placed_again(finished: Layer) -> None:
    position = take_out(finished, 15, 1)
    (place,) = missing.missing(finished).places
    assert (place.frame, place.why, place.position, place.is_absence) == (15, Why.PROPOSED, position, True)
    missing.place(finished, 15, place.position, 1, None)
    assert missing.missing(finished).places == []
    assert Annotation.objects.get(layer=finished, frame__number=15, person=1).origin == "proposed"


def test_a_place_somebody_looked_at_is_not_listed_again(finished: Layer) -> None:
    take_out(finished, 15, 1)
    (place,) = missing.missing(finished).places
    missing.dismiss(finished, place.frame, place.position, None)
    assert missing.missing(finished).places == []


def test_without_proposals_holes_still_tell(finished: Layer) -> None:
    runs.use_none(finished.dataset)
    take_out(finished, 15, 1)
    report = missing.missing(finished)
    assert report.run is None
    assert [place.why for place in report.places] == [Why.HOLE]


def test_somebody_no_box_shows_is_listed_where_the_detector_looked_everywhere(finished: Layer) -> None:
    dataset = finished.dataset
    far = int(dataset.grid.position([(4.0, -4.0)])[0])
    frame = dataset.frames.get(number=20)
    people = [row(one.person, one.position) for one in Annotation.objects.filter(layer=finished, frame=frame)]
    save(finished, frame, [*people, row(9, far)], revision=1, done=True)
    assert missing.missing(finished).places == []
    for digest in pictures_of([frame])[frame.pk].digests.values():
        PictureBoxes.objects.create(picture=digest, model=Watcher.model, boxes=[])
    (place,) = missing.missing(finished).places
    assert (place.frame, place.why, place.person, place.is_absence) == (20, Why.UNSUPPORTED, 9, False)


def test_a_place_without_a_frame_or_with_somebody_there_changes_nothing(finished: Layer) -> None:
    before = list(Annotation.objects.values_list())
    for number, person in ((3, None), (15, 1)):
        with pytest.raises(ProposalError):
            missing.place(finished, number, 100, person, None)
    assert list(Annotation.objects.values_list()) == before


def test_a_workers_layer_is_looked_through_and_changed_by_that_worker_only(dataset: Dataset) -> None:
    batches.make_batches(dataset, size=8)
    mine = assignments.claim(make_worker(), dataset)
    with pytest.raises(assignments.ReadOnly):
        missing.place(mine.layer, 0, 100, None, None)
    missing.dismiss(mine.layer, 0, 100, None)
    assert Refusal.objects.count() == 1


def test_a_layer_nobody_saved_has_nothing_to_look_through(dataset: Dataset) -> None:
    assert missing.missing(make_layer(dataset)).frames == 0
