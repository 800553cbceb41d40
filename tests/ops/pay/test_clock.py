"""Active seconds the server believes: never more than real time, and nothing of an honest browser lost."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.models import Assignment, LayerFrame, Save
from gtm_hit.ops.frames.saving import StaleSave
from gtm_hit.ops.pay.clock import KEPT, Clock, count
from gtm_hit.ops.work import assignments, batches
from tests.work_scene import make_dataset, make_worker, row, save

START = datetime(2026, 11, 25, 12, tzinfo=UTC)
LONGEST = 7200.0


def counted(*saves: tuple[float, float]) -> list[float]:
    """What counts of saves at so many seconds that tell of so many."""
    clock, found = Clock(START, START), []
    for at, told in saves:
        clock, seconds = count(clock, START + timedelta(seconds=at), told, LONGEST)
        found.append(round(seconds, 3))
    return found


def test_what_took_that_long_counts() -> None:
    assert counted((60, 55), (100, 38), (130, 30)) == [55, 38, 30]


def test_two_tabs_that_tell_of_the_same_minutes_are_counted_once() -> None:
    assert sum(counted(*((minute * 60 + tab, 60) for minute in range(1, 11) for tab in (0, 1)))) <= 601


def test_a_pause_gives_two_tabs_little_to_count_from() -> None:
    after_lunch = [(3600, 20), *((3600 + at * 60 + tab, 60) for at in range(1, 11) for tab in (0, 1))]
    assert sum(counted(*after_lunch)) <= 20 + 601 + KEPT


def test_frames_that_come_together_after_a_time_without_network_keep_all_their_seconds() -> None:
    assert counted((1800, 400), (1801, 600), (1802, 790)) == [400, 600, 790]


def test_a_frame_looked_at_before_and_saved_after_another_keeps_its_seconds() -> None:
    assert counted((60, 20), (90, 30), (120, 70)) == [20, 30, 70]


def test_more_than_the_time_since_the_lease_is_not_believed() -> None:
    assert counted((30, 86_400)) == [30]


def test_a_clock_that_was_set_back_takes_nothing_away() -> None:
    assert counted((100, 50), (40, 10), (110, 30)) == [50, 10, 30]


@given(
    st.lists(
        st.tuples(st.floats(0, 4000, allow_nan=False), st.floats(0, 90_000, allow_nan=False)), max_size=30
    )
)
def test_all_seconds_together_never_exceed_real_time(steps: list[tuple[float, float]]) -> None:
    at, saves = 0.0, []
    for passed, told in steps:
        at += passed
        saves.append((at, told))
    assert sum(counted(*saves)) <= at + 0.01 * len(saves)


@given(st.lists(st.tuples(st.floats(1, 600), st.floats(0, 1)), max_size=30))
def test_of_one_tab_that_saves_what_it_worked_nothing_is_lost(steps: list[tuple[float, float]]) -> None:
    at, saves = 0.0, []
    for passed, share in steps:
        at += passed
        saves.append((at, passed * share))
    assert counted(*saves) == pytest.approx([told for _at, told in saves], abs=0.01)


@pytest.fixture
def assignment(db: None) -> Assignment:
    dataset = make_dataset()
    batches.make_batches(dataset)
    assignment = assignments.claim(make_worker(), dataset)
    Assignment.objects.update(leased_at=assignment.leased_at - timedelta(seconds=100))
    return assignment


def send(assignment: Assignment, frame: int = 0, **values: Any) -> Any:
    frames = assignment.batch.frames.order_by("number")
    return save(assignment.layer, frames[frame], [row()], author=assignment.worker, **values)


def total(assignment: Assignment) -> float:
    return sum(LayerFrame.objects.filter(layer=assignment.layer).values_list("seconds", flat=True))


def test_a_save_counts_no_more_seconds_than_passed_since_the_lease(assignment: Assignment) -> None:
    send(assignment, 0, seconds=80)
    send(assignment, 1, seconds=80)
    assert total(assignment) == pytest.approx(100, abs=5)
    assert assignment.clock.told == 160


def test_a_save_that_is_sent_again_counts_once(assignment: Assignment) -> None:
    send(assignment, seconds=40)
    again = Save.objects.get().save_id
    send(assignment, seconds=40, save_id=again)
    assert (total(assignment), assignment.clock.counted) == (40, 40)


def test_seconds_of_a_refused_save_wait_for_the_next(assignment: Assignment) -> None:
    send(assignment, seconds=10)
    with pytest.raises(StaleSave):
        send(assignment, seconds=30)
    send(assignment, revision=1, seconds=50)
    assert total(assignment) == 60
