"""Two text files of `frame column row` lines against each other; needs no database."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from django.core.files.uploadedfile import UploadedFile

from gtm_hit.formats.annotations import frame_column_row
from gtm_hit.formats.problems import FormatError, Problem
from gtm_hit.metrics import detection
from gtm_hit.metrics.annotations import Annotations, MetricsError
from gtm_hit.metrics.limits import MOST_PAIRS, check_size
from gtm_hit.metrics.matching import RADIUS

SCORES = ("moda", "modp", "precision", "recall", "radius")
COUNTS = ("frames", "truth", "found", "matched", "missed", "extra")
MOST_UPLOADED = 2_000_000  # bytes of a file, about 5,000 frames: longer ones keep a request waiting


@dataclass(frozen=True)
class Question:
    """`step`: metres between neighbouring positions; with `identities` lines have a person, too."""

    truth: Path
    found: Path
    step: float
    radius: float = RADIUS
    identities: bool = False
    curve: bool = False
    most_pairs: int | None = None  # of people, over all frames; None: as many as there are


def evaluate(asked: Question) -> dict[str, Any]:
    """JSON's types only; scores as fractions, metres; what is not defined is null.

    A frame that only one of the files has counts as well: its people are all missed, or all extra.
    Raises MetricsError for a step or radius that is none and for crowds too large, FormatError with
    everything wrong in either file.
    """
    for name in ("step", "radius"):
        value = getattr(asked, name)
        if not (math.isfinite(value) and value > 0):
            raise MetricsError(f"{name} must be a positive number of metres, not {value}")
    truth, found = _read_both(asked)
    check_size(truth, found, asked.most_pairs)
    score = detection.evaluate(truth, found, asked.radius)
    result: dict[str, Any] = {name: getattr(score, name) for name in (*SCORES, *COUNTS)}
    if asked.identities:
        result |= _identity_scores(truth, found, asked.radius)
    result = {name: _plain(value) for name, value in result.items()}
    if asked.curve:
        scores = detection.curve(truth, found)
        result["curve"] = [{name: _plain(getattr(each, name)) for name in SCORES} for each in scores]
    return result


def evaluate_uploads(truth: UploadedFile, found: UploadedFile, **asked: Any) -> dict[str, Any]:
    """The same of files that came with a request; problems name them truth.txt and found.txt."""
    with TemporaryDirectory(prefix="evaluation-") as name:
        folder = Path(name)
        paths = folder / "truth.txt", folder / "found.txt"
        for path, file in zip(paths, (truth, found), strict=True):
            path.write_bytes(file.read())
        try:
            return evaluate(Question(*paths, **asked, most_pairs=MOST_PAIRS))
        except FormatError as error:
            raise error.relative_to(folder) from error


def _read_both(asked: Question) -> tuple[Annotations, Annotations]:
    """Both files, or the problems of both: whoever repairs a file wants to see all of them at once."""
    problems: list[Problem] = []
    sides = []
    for path in (asked.truth, asked.found):
        try:
            lines = frame_column_row.read(path, persons=asked.identities, may_be_empty=True)
        except FormatError as error:
            problems += error.problems
            continue
        xy = np.column_stack((lines.columns, lines.rows)).astype(np.float64) * asked.step
        sides.append(Annotations(lines.frames, xy, lines.persons))
    if problems:
        raise FormatError(problems)
    return sides[0], sides[1]


def _identity_scores(truth: Annotations, found: Annotations, radius: float) -> dict[str, float | int]:
    # pandas, behind motmetrics, takes longer to import than the rest takes to run.
    from gtm_hit.metrics import tracking

    score = tracking.evaluate(truth, found, radius).score
    return {
        "mota": score.mota,
        "motp": score.motp,
        "mean_distance": score.mean_distance,
        "idf1": score.idf1,
        "id_precision": score.id_precision,
        "id_recall": score.id_recall,
        "switches": score.switches,
        "truth_persons": score.truth_persons,
        "found_persons": score.found_persons,
        "hota": score.hota.hota,
        "deta": score.hota.detection,
        "assa": score.hota.association,
        "loca": score.hota.localisation,
    }


def _plain(value: float | int) -> float | int | None:
    """JSON has no NaN."""
    return None if math.isnan(value) else value
