"""The variants of an adjustment: which passes are made, and when each has come to its end."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from gtm_hit.calibration.adjustment import checks, gauge
from gtm_hit.calibration.adjustment.covariance import Uncertainty, uncertainty
from gtm_hit.calibration.adjustment.errors import AdjustmentError
from gtm_hit.calibration.adjustment.parameters import packed, unpacked
from gtm_hit.calibration.adjustment.problem import Problem, View
from gtm_hit.calibration.adjustment.residuals import Seen
from gtm_hit.calibration.adjustment.settings import Settings, Variant
from gtm_hit.calibration.adjustment.settling import settled
from gtm_hit.calibration.adjustment.solver import FIRST_DAMPING, Place, step_down
from gtm_hit.calibration.adjustment.state import State, digest_of
from gtm_hit.calibration.adjustment.system import Cost, System, all_points, observations, system_of

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Pass:
    lenses: bool  # may move
    soft: bool  # … but are held near where they started
    rough: bool  # another pass follows


PASSES = {
    Variant.FIXED: (Pass(False, False, False),),
    Variant.BOTH: (Pass(True, False, False),),
    Variant.TWO_PASS: (Pass(False, False, True), Pass(True, False, False)),
    Variant.SOFT: (Pass(False, False, True), Pass(True, True, False)),
}
MOST_ROUNDS = 3  # of one pass: after each, points look for deeper hollows


@dataclass(frozen=True)
class Step:
    """What `progress` is told after each step."""

    pass_number: int  # from 1
    passes: int
    number: int  # from 1, of all
    cost: float


Progress = Callable[[Step], object]
Stop = Callable[[], bool]


@dataclass(frozen=True, eq=False)
class Adjustment:
    """What came out. `finished` is false where it was stopped; `state` then leads on from there."""

    problem: Problem
    variant: Variant
    settings: Settings
    views: tuple[View, ...]
    points: Floats  # (P, 3) metres; NaN for points that were left out
    measured: Floats  # (M, 3) metres; as given, unless they may be off
    cost: Cost
    seen: Seen  # the observations that counted; points are numbered free ones first
    uncertainty: Uncertainty | None  # None where it was stopped
    notices: tuple[str, ...]  # what was left out, what holds the world, what looks doubtful
    steps: int
    finished: bool
    state: State


def adjust(
    problem: Problem,
    variant: Variant = Variant.SOFT,
    settings: Settings | None = None,
    progress: Progress | None = None,
    stop: Stop | None = None,
    state: State | None = None,
) -> Adjustment:
    """Adjust all views and points at once; with `state`, go on from where an earlier call was stopped.

    The same input gives the same bytes, however often it was stopped in between. AdjustmentError names what
    makes the problem unsolvable, or the camera that no result can be trusted for.
    """
    run = _Run(problem, Variant(variant), settings or Settings())
    here = run.first_state() if state is None else run.checked(state)
    while not run.is_over(here):
        if stop and stop():
            break
        before, here = here, run.moved(here)
        if progress and here.steps > before.steps:
            progress(Step(before.pass_number + 1, len(run.passes), here.steps, here.cost))
    return run.result(here)


class _Run:
    def __init__(self, problem: Problem, variant: Variant, settings: Settings) -> None:
        self.problem, self.variant, self.settings = problem, variant, settings
        self.passes = PASSES[variant]
        checks.check(problem)
        self.seen, self.notices = checks.usable(problem, observations(problem, settings))
        self.gauge = gauge.chosen(problem, self.seen)
        self.system = lru_cache(self._system)
        self.digest = digest_of(problem, variant, settings)

    def first_state(self) -> State:
        return State(self.digest, packed(self.problem.views), all_points(self.problem))

    def checked(self, state: State) -> State:
        if state.of != self.digest:
            raise AdjustmentError("Clicks, points or settings have changed since it was stopped: start anew.")
        return state

    def is_over(self, state: State) -> bool:
        return state.pass_number == len(self.passes)

    def moved(self, state: State) -> State:
        """One step on."""
        return self.walked(state) if state.walking else self.settled(state)

    def settled(self, state: State) -> State:
        """Every point in its deepest hollow, for a first or another round; or the next pass."""
        system = self.system(state.pass_number)
        points = settled(state.rows, state.points, self.seen, system.movable, self.settings.turn)
        cost = system.cost(state.rows, points).total
        pays = state.round == 0 or cost < state.cost * (1 - self.tolerance(state))
        if pays and state.round < MOST_ROUNDS:
            begun = replace(state, round=state.round + 1, walking=True, steps_of_round=0)
            return replace(begun, points=points, cost=cost, damping=FIRST_DAMPING)
        return replace(state, pass_number=state.pass_number + 1, round=0)

    def walked(self, state: State) -> State:
        here = Place(state.rows, state.points, state.cost, state.damping)
        after = step_down(self.system(state.pass_number), here)
        count = state.steps_of_round + 1
        goes_on = here.cost - after.cost > self.tolerance(state) * here.cost
        return replace(
            state,
            rows=after.rows,
            points=after.points,
            cost=after.cost,
            damping=after.damping,
            steps=state.steps + 1,
            steps_of_round=count,
            walking=goes_on and count < self.settings.most_steps,
        )

    def tolerance(self, state: State) -> float:
        rough = self.passes[state.pass_number].rough
        return self.settings.rough_tolerance if rough else self.settings.tolerance

    def result(self, state: State) -> Adjustment:
        finished = self.is_over(state)
        last = self.system(min(state.pass_number, len(self.passes) - 1))
        rows, points = self.gauge.restored(state.rows, state.points)
        free = len(self.problem.points)
        views = unpacked(rows, self.problem.views)
        left_out = np.setdiff1d(np.arange(free), self.seen.points)
        found = points[:free].copy()
        found[left_out] = np.nan
        notices = (*self.notices, *self.gauge.notices)
        if finished:
            checks.check_result(views, rows, points, self.seen)
            notices += checks.doubts(rows, points, self.seen, free, self.problem.labels)
        return Adjustment(
            problem=self.problem,
            variant=self.variant,
            settings=self.settings,
            views=views,
            points=found,
            measured=points[free:],
            cost=last.cost(state.rows, state.points),
            seen=self.seen,
            uncertainty=uncertainty(last, state.rows, state.points) if finished else None,
            notices=notices,
            steps=state.steps,
            finished=finished,
            state=state,
        )

    def _system(self, number: int) -> System:
        each = self.passes[number]
        held = self.gauge.held
        return system_of(self.problem, self.settings, self.seen, held, each.lenses, each.soft)
