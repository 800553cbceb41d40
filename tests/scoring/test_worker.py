"""The score falls with every error and becomes surer with every piece of evidence."""

from __future__ import annotations

from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.scoring.evidence import Evidence
from gtm_hit.scoring.suspicion import Usual, careless, suspicion, usual
from gtm_hit.scoring.worker import PARTS, measured_parts, score

counts = st.integers(0, 400)


@st.composite
def evidences(draw: st.DrawFn) -> Evidence:
    matched = draw(counts)
    placed, same = draw(st.integers(0, matched)), draw(st.integers(0, matched))
    faults, shared, finished = draw(counts), draw(counts), draw(st.integers(0, 50))
    return Evidence(
        truth=matched + draw(counts),
        found=matched + draw(counts),
        matched=matched,
        placed=placed,
        same=same,
        faults=faults,
        repaired=draw(st.integers(0, faults)),
        shared=shared,
        agreed=draw(st.integers(0, shared)),
        people=draw(counts),
        finished=finished,
        careless=draw(st.floats(0, 1)) * finished,
        dropped=draw(st.integers(0, 20)),
    )


WORSE = [
    {"truth": 1},  # one more missed
    {"found": 1},  # one more invented
    {"truth": 1, "found": 1, "matched": 1},  # one more found, badly placed
    {"faults": 1},
    {"shared": 1},
    {"warnings": 1},
    {"dropped": 1},
]


@given(evidences(), st.sampled_from(WORSE[:2] + WORSE[3:]))
def test_one_more_error_never_raises_the_score(evidence: Evidence, more: dict[str, int]) -> None:
    worse = replace(evidence, **{name: getattr(evidence, name) + value for name, value in more.items()})
    assert score(worse).score <= score(evidence).score + 1e-9


@given(evidences())
def test_a_fault_that_was_repaired_instead_of_left_never_lowers_the_score(evidence: Evidence) -> None:
    left = evidence + Evidence(faults=1)
    repaired = evidence + Evidence(faults=1, repaired=1)
    assert score(repaired).score >= score(left).score


@given(evidences(), st.integers(4, 50))
def test_more_of_the_same_evidence_narrows_every_part(evidence: Evidence, times: int) -> None:
    once = {one.name: one for one in score(evidence).parts}
    more = Evidence(**{name: value * times for name, value in evidence.as_dict().items()})
    for part in score(more).parts:
        before = once[part.name]
        if before.good + before.bad >= 10:
            assert part.deviation < before.deviation


@given(evidences())
def test_the_score_is_inside_its_interval_and_the_interval_inside_0_and_100(evidence: Evidence) -> None:
    found = score(evidence)
    assert 0 <= found.low <= found.score <= found.high <= 100


def test_without_evidence_next_to_nothing_is_claimed() -> None:
    nothing = score(Evidence())
    assert nothing.high - nothing.low > 50


def test_a_good_worker_gets_near_100_and_a_bad_one_far_from_it() -> None:
    good = Evidence(
        truth=400, found=398, matched=396, placed=390, same=392, faults=10, repaired=10, finished=5
    )
    bad = Evidence(truth=400, found=300, matched=290, placed=150, same=250, faults=10, finished=5, careless=4)
    measured = measured_parts(good)
    assert score(good, measured).low > 80
    assert score(bad, measured).high < 55


def test_what_the_campaign_does_not_measure_does_not_count() -> None:
    good = Evidence(truth=4000, found=4000, matched=4000, placed=4000, same=4000)
    assert score(good, measured_parts(good)).score > 95
    assert score(good).score < 95


def test_what_cost_most_is_named_first() -> None:
    evidence = Evidence(truth=100, found=100, matched=100, placed=100, same=100, faults=10)
    assert score(evidence).parts[0].name == "faults"
    assert {one.name for one in score(evidence).parts} == {part.name for part in PARTS}


@given(evidences(), evidences())
def test_evidence_adds_up(one: Evidence, other: Evidence) -> None:
    assert (one + other).truth == one.truth + other.truth
    assert Evidence.from_dict((one + other).as_dict()) == one + other


CAREFUL = Evidence(people=240, seconds=1000, carried=200, untouched=80, edits=260, warnings=1, finished=1)


def test_nothing_speaks_against_usual_work() -> None:
    assert suspicion(CAREFUL, usual([CAREFUL] * 3)).value == 0


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("pace", {"seconds": 60}),
        ("untouched", {"untouched": 200}),
        ("edits", {"edits": 5}),
        ("warnings", {"warnings": 60}),
        ("gold", {"truth": 24, "found": 18, "matched": 15, "placed": 9}),
        ("faults", {"faults": 2}),
        ("agreement", {"shared": 480, "agreed": 300}),
    ],
)
def test_each_signal_is_heard_and_named(name: str, values: dict[str, float]) -> None:
    found = suspicion(replace(CAREFUL, **values), usual([CAREFUL] * 3))
    assert found.value > 0.2
    assert [signal.name for signal in found.signals] == [name]


@given(st.integers(0, 10), st.integers(0, 10))
def test_more_faults_left_are_more_suspicious(repaired: int, left: int) -> None:
    here = Evidence(faults=repaired + left, repaired=repaired)
    more = Evidence(faults=repaired + left + 1, repaired=repaired)
    assert suspicion(more, Usual()).value > suspicion(here, Usual()).value


def test_a_handful_of_people_says_nothing_about_pace() -> None:
    assert careless(Evidence(people=5, seconds=1, finished=1), Usual()) == 0
