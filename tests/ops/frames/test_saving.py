from __future__ import annotations

import uuid
from typing import Any

import pytest
from django.contrib.auth.models import User
from django.db import connection
from django.test.utils import CaptureQueriesContext

from gtm_hit.models import Annotation, AppendOnlyError, Frame, Layer, LayerFrame, Save
from gtm_hit.ops.frames.rules import InvalidFrame
from gtm_hit.ops.frames.saving import (
    SaveIdUsed,
    StaleSave,
    UnknownRevision,
    history,
    next_person,
    read_frame,
    read_frames,
    save_frame,
    state_at,
)
from gtm_hit.ops.work.assignments import ReadOnly
from tests.work_scene import add_frames, as_sent, make_dataset, make_layer, make_worker, row, save


@pytest.fixture
def layer(db: None) -> Layer:
    return make_layer(make_dataset(frames=3))


@pytest.fixture
def frame(layer: Layer) -> Frame:
    return layer.dataset.frames.order_by("number")[1]


def written() -> tuple[int, int, int]:
    return Save.objects.count(), Annotation.objects.count(), LayerFrame.objects.count()


def test_a_frame_never_saved_is_empty(layer: Layer, frame: Frame) -> None:
    state = read_frame(layer, frame)
    assert (state.revision, state.annotations, state.done, state.saved_at) == (0, [], False, None)


def test_a_save_replaces_the_frame(layer: Layer, frame: Frame) -> None:
    save(layer, frame, [row(1), row(2, 7)])
    state = save(layer, frame, [row(2, 8), row(3, 9)], 1, done=True)
    assert state == read_frame(layer, frame)
    assert state.revision == 2
    assert as_sent(state.annotations) == [row(2, 8), row(3, 9)]
    assert state.done


def test_annotations_are_stored_by_person_with_every_key(layer: Layer, frame: Frame) -> None:
    save(layer, frame, [{"person": 5, "position": 1}, row(2, height=1.5)])
    kept = as_sent(state_at(layer, frame, 1).annotations)
    assert kept == Save.objects.get().annotations == [row(2, height=1.5), row(5, 1)]
    assert list(kept[0]) == ["person", "position", "state", "origin", "height", "radius"]


def test_rows_that_did_not_change_are_not_touched(layer: Layer, frame: Frame) -> None:
    save(layer, frame, [row(1), row(2, 7)])
    before = dict(Annotation.objects.values_list("person", "pk"))
    save(layer, frame, [row(1), row(2, 8)], 1)
    assert dict(Annotation.objects.values_list("person", "pk")) == before


def test_seconds_add_up(layer: Layer, frame: Frame) -> None:
    save(layer, frame, [], seconds=1.5)
    save(layer, frame, [], 1, seconds=2)
    assert LayerFrame.objects.get().seconds == 3.5


def test_the_author_is_recorded(layer: Layer, frame: Frame) -> None:
    user = User.objects.create_user("manager")
    assert save(layer, frame, [], author=user).author == "manager"
    assert Save.objects.get().user == user


def test_the_same_save_again_answers_as_before_even_when_others_followed(layer: Layer, frame: Frame) -> None:
    save_id = uuid.uuid4()
    first = save(layer, frame, [row(1)], save_id=save_id)
    save(layer, frame, [row(2)], 1)
    assert save(layer, frame, [row(1)], save_id=save_id) == first
    assert written() == (2, 1, 1)


@pytest.mark.parametrize("other", [{"done": True}, {"rows": [row(2)]}, {"revision": 1}])
def test_another_save_under_a_used_id_is_refused(layer: Layer, frame: Frame, other: dict[str, Any]) -> None:
    save_id = uuid.uuid4()
    save(layer, frame, [row(1)], save_id=save_id)
    sent: dict[str, Any] = {"rows": [row(1)], "revision": 0, **other}
    with pytest.raises(SaveIdUsed):
        save(layer, frame, sent.pop("rows"), save_id=save_id, **sent)
    assert written() == (1, 1, 1)


def test_a_save_id_is_good_for_one_layer(layer: Layer, frame: Frame) -> None:
    save_id = uuid.uuid4()
    save(layer, frame, [row(1)], save_id=save_id)
    with pytest.raises(SaveIdUsed):
        save(make_layer(layer.dataset, "other"), frame, [row(1)], save_id=save_id)
    assert written() == (1, 1, 1)


@pytest.mark.parametrize("revision", [0, 2, 99])
def test_a_save_from_another_revision_is_stale_and_shows_the_present(
    layer: Layer, frame: Frame, revision: int
) -> None:
    current = save(layer, frame, [row(1)])
    with pytest.raises(StaleSave) as stale:
        save(layer, frame, [row(2)], revision)
    assert stale.value.current == current
    assert written() == (1, 1, 1)


def test_a_refused_first_save_leaves_nothing(layer: Layer, frame: Frame) -> None:
    with pytest.raises(StaleSave):
        save(layer, frame, [row(1)], 4)
    with pytest.raises(InvalidFrame):
        save(layer, frame, [row(1, -1)])
    assert written() == (0, 0, 0)


def test_a_frame_of_another_dataset_is_refused(layer: Layer) -> None:
    stray = make_dataset("other", frames=1).frames.get()
    with pytest.raises(ValueError, match="not in the dataset"):
        save(layer, stray, [])
    assert written() == (0, 0, 0)


@pytest.mark.parametrize("kind", Layer.Kind.values)
def test_a_worker_changes_no_layer_that_is_not_his(layer: Layer, frame: Frame, kind: str) -> None:
    Layer.objects.update(kind=kind)
    layer.refresh_from_db()
    with pytest.raises(ReadOnly, match="not_author"):
        save(layer, frame, [], author=make_worker())
    assert written() == (0, 0, 0)


def test_staff_do_not_change_a_workers_layer(layer: Layer, frame: Frame) -> None:
    theirs = make_layer(layer.dataset, "theirs", Layer.Kind.ASSIGNMENT)
    with pytest.raises(ReadOnly, match="not_author"):
        save(theirs, frame, [], author=User.objects.create_user("manager"))
    assert written() == (0, 0, 0)


def test_history_is_complete_and_gives_every_state_back(layer: Layer, frame: Frame) -> None:
    states = [
        save(layer, frame, [row(1)]),
        save(layer, frame, [], 1, nobody=True, done=True),
        save(layer, frame, [row(1), row(2, 3)], 2),
    ]
    assert [(entry.revision, entry.people, entry.done) for entry in history(layer, frame)] == [
        (1, 1, False),
        (2, 0, True),
        (3, 2, False),
    ]
    assert [state_at(layer, frame, revision) for revision in (1, 2, 3)] == states


def test_a_revision_that_never_was_is_unknown(layer: Layer, frame: Frame) -> None:
    save(layer, frame, [])
    with pytest.raises(UnknownRevision):
        state_at(layer, frame, 2)


def test_saves_cannot_be_rewritten(layer: Layer, frame: Frame) -> None:
    save(layer, frame, [])
    with pytest.raises(AppendOnlyError):
        Save.objects.get().save()


def test_a_new_layer_starts_with_person_one(layer: Layer) -> None:
    assert next_person(layer) == 1


def test_the_number_of_a_removed_person_is_not_given_again(layer: Layer, frame: Frame) -> None:
    save(layer, frame, [row(24)])
    save(layer, frame, [], 1)
    assert next_person(layer) == 25


def test_numbers_of_people_written_without_a_save_count_too(layer: Layer, frame: Frame) -> None:
    Annotation.objects.create(layer=layer, frame=frame, person=40, position=1)
    assert next_person(layer) == 41
    save(layer, frame, [])
    assert next_person(layer) == 41


def test_read_frames_keeps_the_order_and_misses_none(layer: Layer, frame: Frame) -> None:
    save(layer, frame, [row(1)])
    frames = list(layer.dataset.frames.order_by("-number"))
    assert [(state.number, state.revision) for state in read_frames(layer, frames)] == [
        (10, 0),
        (5, 1),
        (0, 0),
    ]


def test_reading_takes_three_queries_for_any_number_of_frames(
    layer: Layer, django_assert_num_queries: Any
) -> None:
    for frame in add_frames(layer.dataset, 30):
        save(layer, frame, [row(1), row(2, 5)])
    frames = list(layer.dataset.frames.all())
    with django_assert_num_queries(3):
        assert len(read_frames(layer, frames)) == 33


def queries_of_a_save(layer: Layer, frame: Frame, people: int) -> int:
    save(layer, frame, [row(person) for person in range(people)])
    moved = [row(person, 3) for person in range(1, people + 1)]
    with CaptureQueriesContext(connection) as queries:
        save(layer, frame, moved, 1)
    return len(queries)


def test_a_save_takes_as_many_queries_in_a_long_layer_as_in_a_short_one(layer: Layer, frame: Frame) -> None:
    short = queries_of_a_save(layer, frame, 20)
    for other in add_frames(layer.dataset, 50):
        save(layer, other, [row(person) for person in range(20)])
    number = layer.dataset.frames.get(number=0)
    assert queries_of_a_save(layer, number, 20) == short <= 12


def test_a_save_takes_as_many_queries_for_forty_people_as_for_two(layer: Layer) -> None:
    first, second, _third = layer.dataset.frames.all()
    assert queries_of_a_save(layer, first, 2) == queries_of_a_save(layer, second, 40)


def test_five_hundred_people_fit(layer: Layer, frame: Frame) -> None:
    save_frame(layer, frame, None, uuid.uuid4(), 0, [row(person, person) for person in range(500)])
    assert Annotation.objects.count() == 500
