"""The README of a release: what it is, and the numbers a paper prints."""

from __future__ import annotations

from collections.abc import Iterable

from gtm_hit.metrics.coverage import Coverage
from gtm_hit.metrics.statistics import Distribution
from gtm_hit.ops.quality.statistics.measuring import LayerStatistics

DISTRIBUTIONS = (
    ("people_per_frame", "People per frame", "people"),
    ("track_annotations", "Annotated frames per person", "frames"),
    ("track_path", "Distance walked per person", "m"),
    ("speed", "Speed between neighbouring frames", "m/s"),
    ("height", "Height", "m"),
)


def readme(
    title: str,
    number: int,
    files: str,
    found: LayerStatistics,
    ground: Coverage,
    changes: dict[str, int],
    since: int | None,
    figures: Iterable[str],
) -> str:
    """Markdown; `files` is what the export's own README says of them."""
    summary = found.summary
    heading = f"{found.dataset}, release {number}" + (f": {title}" if title else "")
    return "\n".join(
        [
            f"# {heading}",
            "",
            f"{summary.frames} frames, {summary.people} people, {summary.annotations} annotations.",
            _since(changes, since),
            "The licence is in `LICENSE`, who annotated what in `provenance.csv`.",
            "",
            *_statistics(found, ground),
            *(f"![{name}](figures/{name}.svg)" for name in figures),
            "",
            *_files(files),
        ]
    )


def _statistics(found: LayerStatistics, ground: Coverage) -> list[str]:
    views = " | ".join(f"{name} {count}" for name, count in _visible(found))
    exactly = " | ".join(f"{k}: {count}" for k, count in enumerate(found.visibility.exactly.tolist()))
    seen = " | ".join(f"{k}: {count}" for k, count in enumerate(ground.counts.tolist()))
    return [
        "## Statistics",
        "",
        "| | mean | median | 5 % | 95 % | least | most | of |",
        "|---|---|---|---|---|---|---|---|",
        *(_row(words, getattr(found.summary, name), unit) for name, words, unit in DISTRIBUTIONS),
        "",
        f"Annotations visible in each view: {views}",
        "",
        f"Annotations visible in exactly k views: {exactly}",
        "",
        f"Positions seen by exactly k cameras, every {ground.every}th along both axes: {seen}; "
        f"mean {ground.mean:.2f}",
        "",
    ]


def _files(files: str) -> list[str]:
    return [
        "## Files",
        "",
        "```",
        files.rstrip(),
        "LICENSE         the terms of use",
        "provenance.csv  for every annotation: worker's pseudonym, origin, share of the active seconds",
        "changes.json    people added, removed and moved since the release before, by frame",
        "figures/        the figures above",
        "```",
        "",
    ]


def _visible(found: LayerStatistics) -> Iterable[tuple[str, int]]:
    return zip(found.cameras, found.visibility.per_view.tolist(), strict=True)


def _since(changes: dict[str, int], since: int | None) -> str:
    if since is None:
        return "The first release."
    return (
        f"Since release {since}: {changes['added']} annotations added, {changes['removed']} removed, "
        f"{changes['moved']} moved, in {changes['frames']} frames."
    )


def _row(words: str, values: Distribution, unit: str) -> str:
    if not values.count:
        return f"| {words} | | | | | | | 0 |"
    numbers = (values.mean, values.median, values.p05, values.p95, values.least, values.most)
    return f"| {words}, {unit} | " + " | ".join(f"{value:.2f}" for value in numbers) + f" | {values.count} |"
