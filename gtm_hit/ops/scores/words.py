"""Scores and suspicions in plain words."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from django.utils.translation import gettext as _

from gtm_hit.models import AssignmentScore, WorkerScore

SAID = 0.5  # points; what costs less is not worth a sentence
MOST_SAID = 4
ENOUGH = 3  # submitted batches before a worker is told


def of_score(row: WorkerScore) -> list[str]:
    """What the score is made of, what cost most first."""
    told = [
        one for one in row.reasons if one["lost"] >= SAID and one["bad"] >= 0.05 * (one["good"] + one["bad"])
    ]
    told = [one for one in told if one["bad"] > 0][:MOST_SAID]
    unknown = [one for one in row.reasons if one["good"] + one["bad"] == 0]
    lines = [part_in_words(one) for one in told] or [_("Nothing speaks against the work.")]
    if unknown:
        names = ", ".join(part_names()[one["part"]] for one in unknown)
        lines.append(_("Not known yet: %(parts)s.") % {"parts": names})
    return lines


def part_names() -> dict[str, str]:
    return {
        "found": _("people found in gold frames"),
        "placed": _("distance in gold frames"),
        "identity": _("identities in gold frames"),
        "faults": _("planted faults"),
        "agreement": _("agreement with others"),
        "plausible": _("warnings"),
        "care": _("way of working"),
        "finishing": _("finishing"),
    }


def part_in_words(one: Mapping[str, Any]) -> str:
    good, bad = one["good"], one["bad"]
    values = {
        "good": round(good),
        "bad": round(bad),
        "all": round(good + bad),
        "percent": percent(bad, good + bad),
    }
    sentences = {
        "found": _("%(good)d people of gold frames found, %(bad)d missed or invented."),
        "placed": _("%(bad)d of %(all)d people in gold frames stand more than 15 cm off."),
        "identity": _("%(bad)d of %(all)d people in gold frames go by a wrong number."),
        "faults": _("%(good)d of %(all)d planted faults repaired."),
        "agreement": _("%(percent)d %% of the people differ from what others marked in the same frames."),
        "plausible": _("%(bad)d warnings of people too close or too fast."),
        "care": _("The way of working looks careless in %(percent)d %% of the batches."),
        "finishing": _("%(bad)d of %(all)d batches ran out unfinished."),
    }
    return sentences[one["part"]] % values


def of_suspicion(row: AssignmentScore) -> list[str]:
    """Strongest first; empty when nothing speaks against it."""
    return [signal_in_words(reason) for reason in row.reasons]


def signal_in_words(reason: Mapping[str, Any]) -> str:
    value, usual = reason["value"], reason["usual"]
    values = {
        "value": value,
        "usual": usual,
        "percent": round(100 * value),
        "usual_percent": round(100 * usual),
        "count": round(value),
        "all": round(usual),
    }
    sentences = {
        "gold": _("%(percent)d %% of the people in gold frames are missed, invented or misplaced."),
        "faults": _("%(count)d of %(all)d planted faults were left."),
        "agreement": _("%(percent)d %% of the people differ from what others marked."),
        "pace": _("%(value).1f s per person; usual are %(usual).1f s."),
        "edits": _("%(value).2f edits per person; usual are %(usual).2f."),
        "warnings": _("%(percent)d warnings per 100 people; usual are %(usual_percent)d."),
        "untouched": _(
            "%(percent)d %% of the people stand where they were put; usual are %(usual_percent)d %%."
        ),
    }
    return sentences[reason["name"]] % values


def for_worker(row: WorkerScore | None) -> str:
    """The score as its worker reads it; empty before there is enough. Nothing tells how it was measured."""
    if row is None or row.assignments < ENOUGH:
        return ""
    said = _("Your work scores %(score)d of 100.") % {"score": round(row.score)}
    lost = [one for one in row.reasons if one["lost"] >= SAID and one["bad"] > 0]
    costs = [worker_words()[one["part"]] for one in lost if one["part"] in worker_words()][:2]
    if not costs:
        return said
    return said + " " + _("What cost most: %(parts)s.") % {"parts": "; ".join(dict.fromkeys(costs))}


def worker_words() -> dict[str, str]:
    return {
        "found": _("people who were missed, or marked where nobody stands"),
        "placed": _("people marked beside where they stand"),
        "identity": _("people whose numbers changed on the way"),
        "faults": _("people who were left where they should not be"),
        "care": _("batches done in a hurry, or with hardly a correction"),
        "agreement": _("people whom others saw differently"),
        "plausible": _("people too close together, or too fast"),
        "finishing": _("batches that were not finished"),
    }


def percent(part: float, whole: float) -> int:
    return round(100 * part / whole) if whole else 0


@dataclass(frozen=True)
class Interval:
    """A score in whole points, and between which the true one lies nine times out of ten."""

    score: int
    low: int
    high: int


@dataclass(frozen=True)
class Shown(Interval):
    """A score as pages show it, and why."""

    assignments: int
    lines: list[str]

    @property
    def width(self) -> int:
        return max(1, self.high - self.low)


def shown(row: WorkerScore | None) -> Shown | None:
    if row is None:
        return None
    return Shown(round(row.score), round(row.low), round(row.high), row.assignments, of_score(row))
