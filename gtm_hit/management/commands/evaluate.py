from __future__ import annotations

import json
import math
from argparse import ArgumentParser
from pathlib import Path
from typing import Any

import numpy as np
from django.core.management.base import BaseCommand, CommandError

from gtm_hit.formats import frame_column_row
from gtm_hit.formats.problems import FormatError
from gtm_hit.metrics import detection
from gtm_hit.metrics.annotations import Annotations
from gtm_hit.metrics.matching import RADIUS


class Command(BaseCommand):
    help = (
        "Compare detections with ground truth, both text files with one `frame column row` line per person. "
        "A frame that only one of the files has counts as well: its people are all missed, or all extra."
    )
    # Only the two files matter; a site half set up must not keep anybody from comparing them.
    requires_system_checks: list[str] = []

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("truth", type=Path, metavar="GT.txt")
        parser.add_argument("found", type=Path, metavar="DETECTIONS.txt")
        parser.add_argument("--step", type=float, required=True, help="metres between neighbouring positions")
        parser.add_argument(
            "--radius", type=float, default=RADIUS, help="only pairs closer than this are matched, metres"
        )
        parser.add_argument("--json", action="store_true", help="print one object, scores as fractions")
        parser.add_argument(
            "--identities",
            action="store_true",
            help="lines are `frame column row person`; compare the identities as well",
        )

    def handle(self, *args: Any, **options: Any) -> None:
        for name in ("step", "radius"):
            if not (math.isfinite(options[name]) and options[name] > 0):
                raise CommandError(f"--{name} must be a positive number of metres, not {options[name]}")
        truth, found = _read_both(options)
        result = _scores(truth, found, options["radius"], options["identities"])
        if options["json"]:
            self.stdout.write(json.dumps({name: _plain(value) for name, value in result.items()}))
        else:
            self.stdout.write("\n".join(f"{name:<14} {_shown(value)}" for name, value in result.items()))


def _read_both(options: dict[str, Any]) -> tuple[Annotations, Annotations]:
    """Both files, or the problems of both: whoever repairs a file wants to see all of them at once."""
    problems: list[str] = []
    sides = []
    for side in ("truth", "found"):
        try:
            lines = frame_column_row.read(
                options[side], persons=options["identities"], may_be_empty=side == "found"
            )
        except FormatError as error:
            problems += [str(problem) for problem in error.problems]
            continue
        xy = np.column_stack((lines.columns, lines.rows)) * options["step"]
        sides.append(Annotations(lines.frames, xy, lines.persons))
    if problems:
        raise CommandError("\n".join(["nothing was compared:", *problems]))
    return sides[0], sides[1]


def _scores(
    truth: Annotations, found: Annotations, radius: float, identities: bool
) -> dict[str, float | int]:
    score = detection.evaluate(truth, found, radius)
    result: dict[str, float | int] = {
        name: getattr(score, name)
        for name in (
            *("moda", "modp", "precision", "recall", "radius"),
            *("frames", "truth", "found", "matched", "missed", "extra"),
        )
    }
    return result | _identity_scores(truth, found, radius) if identities else result


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
    """JSON has no NaN; a score that is not defined is null."""
    return None if math.isnan(value) else value


def _shown(value: float | int) -> str:
    if isinstance(value, int):
        return str(value)
    return "not defined" if math.isnan(value) else f"{value:.4f}"
