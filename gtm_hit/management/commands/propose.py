from __future__ import annotations

import json
from argparse import ArgumentParser, ArgumentTypeError
from collections.abc import Callable
from pathlib import Path
from typing import Any

from django.core.management.base import BaseCommand, CommandError

from gtm_hit.management.lookups import dataset_named
from gtm_hit.management.progress import ProgressLine
from gtm_hit.models import Dataset, ProposalRun
from gtm_hit.ops.layers.reading import READERS
from gtm_hit.ops.proposals import detectors, from_files, job, layers, runs
from gtm_hit.ops.proposals.errors import ProposalError
from gtm_hit.ops.proposals.proposing import Proposed


class Command(BaseCommand):
    help = (
        "Look for people in every frame of a dataset. Annotators see them as proposals; "
        "with --layer they become a layer to be compared, and annotators see them only with --use."
    )

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("slug", help="the dataset")
        parser.add_argument("--layer", metavar="NAME", help="make a layer of everybody above the threshold")
        parser.add_argument(
            "--threshold",
            type=float,
            default=layers.THRESHOLD,
            help="least score in that layer (%(default)s)",
        )
        parser.add_argument("--method", choices=job.METHODS, default=job.METHODS[0])
        parser.add_argument("--use", action="store_true", help="show these proposals to annotators")
        source = parser.add_mutually_exclusive_group()
        source.add_argument(
            "--detector",
            default=detectors.BUILT_IN,
            metavar="NAME",
            help=f"{detectors.BUILT_IN}, {detectors.NONE}, an address of DETECTOR_ADDRESSES, or "
            f"{detectors.PLUGIN}NAME of an installed package (%(default)s)",
        )
        source.add_argument("--detector-file", type=Path, metavar="FILE", help="Python with create() in it")
        source.add_argument("--detector-module", metavar="MODULE", help="the same as an installed module")
        parser.add_argument(
            "-p",
            "--detector-parameter",
            dest="params",
            action="append",
            default=[],
            type=_parameter,
            metavar="NAME=TYPE:VALUE",
            help="of create(); TYPE is int, float, str or bool",
        )
        source.add_argument(
            "--from-file", type=Path, metavar="PATH", help="people somebody else's program found"
        )
        parser.add_argument(
            "--format", choices=list(READERS), default="mot", help="of --from-file (%(default)s)"
        )
        parser.add_argument("--json", action="store_true", help="print one object")

    def handle(self, *, slug: str, **options: Any) -> None:
        dataset = dataset_named(slug)
        progress = ProgressLine(self.stderr)
        if not 0 <= options["threshold"] <= 1:
            raise CommandError("a threshold is from 0 to 1")
        try:
            if options["layer"]:
                layers.check_name(dataset, options["layer"])
            run, proposed = self.propose(dataset, options, progress)
            progress.finish()
            if options["use"] or not options["layer"]:
                runs.use(run)
            if options["layer"]:
                layers.make_layer(run, options["layer"], options["threshold"])
        except ProposalError as error:
            raise CommandError(str(error)) from error
        finally:
            progress.finish()
        self.tell(run, proposed, options)

    def propose(
        self, dataset: Dataset, options: dict[str, Any], progress: ProgressLine
    ) -> tuple[ProposalRun, Proposed]:
        if options["from_file"]:
            return from_files.take_in(dataset, options["from_file"], options["format"], progress)
        order = job.Order(options["method"], _detector(options), use=False)
        return job.do(dataset, order, progress, params=dict(options["params"]))

    def tell(self, run: ProposalRun, proposed: Proposed, options: dict[str, Any]) -> None:
        seconds = runs.seconds_of(run)
        if options["json"]:
            told = {"run": run.pk, **vars(proposed), "seconds": seconds, "layer": options["layer"]}
            self.stdout.write(json.dumps(told))
            return
        self.stdout.write(
            f"Run {run.pk}: {proposed.frames} frames looked at, {proposed.known} known before; "
            f"{proposed.people} people in {proposed.tracks} tracks, {seconds:.1f} s of looking in all"
        )
        for camera, frames in runs.alarms(run).items():
            self.stdout.write(f"{camera} disagrees with all other cameras in {frames} frames: check its pose")


def _detector(options: dict[str, Any]) -> str:
    if options["detector_file"]:
        return f"{detectors.FILE}{options['detector_file'].resolve()}"
    if options["detector_module"]:
        return f"{detectors.MODULE}{options['detector_module']}"
    return str(options["detector"])


def _parameter(text: str) -> tuple[str, str | int | float | bool]:
    """As CVAT's command line writes them."""
    name, _equals, rest = text.partition("=")
    kind, _colon, value = rest.partition(":")
    try:
        return name, TYPES[kind](value)
    except (KeyError, ValueError) as error:
        raise ArgumentTypeError(f"{text!r} is not NAME=TYPE:VALUE with one of {', '.join(TYPES)}") from error


def _bool(value: str) -> bool:
    return {"true": True, "1": True, "false": False, "0": False}[value.lower()]


TYPES: dict[str, Callable[[str], str | int | float | bool]] = {
    "int": int,
    "float": float,
    "str": str,
    "bool": _bool,
}
