"""All there is to say about a draft, as page, REST and command tell it."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from gtm_hit.models import VideoSync
from gtm_hit.ops.files import sources
from gtm_hit.ops.sync import drafts, job
from gtm_hit.ops.sync.state import source_lines


@dataclass(frozen=True)
class UnderWay:
    """The job that is guessing."""

    id: int
    done: int
    total: int
    message: str


@dataclass(frozen=True)
class Whole:
    """`lines`: what an import of videos is told. `problem`: why no picture can be shown; empty: none."""

    id: int
    source: str
    revision: int
    undo: bool
    redo: bool
    videos: list[dict[str, Any]]
    clocks: list[dict[str, Any]]
    events: list[dict[str, Any]]
    reference: str
    guess: dict[str, Any]
    job: UnderWay | None
    lines: list[str]
    problem: str

    def as_json(self) -> dict[str, Any]:
        return asdict(self)


def whole(draft: VideoSync) -> Whole:
    state, steps, found = drafts.current(draft), drafts.steps(draft), job.under_way(draft)
    content = state.as_json()
    return Whole(
        id=draft.pk,
        source=draft.source,
        revision=draft.revision,
        undo=steps.undo,
        redo=steps.redo,
        videos=draft.facts,
        clocks=list(content["clocks"]),
        events=list(content["events"]),
        reference=state.reference or next((each.file for each in state.clocks if each.used), ""),
        guess=draft.guess,
        job=UnderWay(found.pk, found.done, found.total, found.message) if found else None,
        lines=source_lines(state),
        problem=_problem(draft),
    )


def video_path(draft: VideoSync, index: int) -> Path | None:
    """None where there is no such video, or it was taken away."""
    source = sources.source(draft.source)
    if source is None or not 0 <= index < len(draft.facts):
        return None
    file = Path(draft.facts[index]["file"])
    return source.path / file if sources.holds(source, file) else None


def _problem(draft: VideoSync) -> str:
    source = sources.source(draft.source)
    if source is None:
        return f"The folder {draft.source} is no longer there."
    lost = [each["file"] for each in draft.facts if not sources.holds(source, Path(each["file"]))]
    return f"{', '.join(lost)} no longer lies in {draft.source}." if lost else ""
