"""Calibrations being made: look at them, feed them with files, put them in place."""

from __future__ import annotations

import json
from argparse import ArgumentParser
from pathlib import Path
from typing import Any

from django.core.management.base import BaseCommand, CommandError

from gtm_hit.formats.files import read_source, write_bytes
from gtm_hit.formats.problems import FormatError
from gtm_hit.management import desk_adjusting
from gtm_hit.management.lookups import dataset_named
from gtm_hit.models import Desk
from gtm_hit.ops.desk import (
    adjust_view,
    checks,
    desks,
    edits,
    ground,
    kept,
    lenses,
    overview,
    pictures,
    placing,
)
from gtm_hit.ops.desk.errors import DeskError

MOST_BYTES = 50_000_000


class Command(BaseCommand):
    help = (
        "List calibration desks, or work at one: what is given is done in the order of the options below. "
        "Lenses from pictures of boards: calibrate lens, then --lens."
    )

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("desk", nargs="?", help="its name in addresses; without: all desks are listed")
        parser.add_argument("--new", action="store_true", help="make it")
        parser.add_argument("--dataset", metavar="S", help="with --new: for the cameras of this dataset")
        parser.add_argument(
            "--cameras", nargs="+", default=[], metavar="NAME", help="with --new: without a dataset"
        )
        parser.add_argument("--points", type=Path, metavar="FILE", help="measured points, CSV or JSON")
        parser.add_argument("--unit", choices=["m", "cm", "mm"], default="", help="of all files given")
        two: Any = {"nargs": 2, "action": "append", "default": []}
        parser.add_argument("--lens", metavar=("CAMERA", "FILE"), help="a lens that is known", **two)
        parser.add_argument("--picture", metavar=("CAMERA", "FILE"), help="picture of the ground", **two)
        parser.add_argument("--clicks", metavar=("CAMERA", "FILE"), help="clicks, JSON", **two)
        parser.add_argument(
            "--kept", type=Path, metavar="FILE", help="keep its points, CSV of thing,camera,x,y[,use] or JSON"
        )
        parser.add_argument(
            "--use",
            choices=kept.Use.values,
            default=kept.Use.TEST.value,
            help="of --kept, where the file says none (%(default)s)",
        )
        desk_adjusting.add_arguments(parser)
        parser.add_argument(
            "--undo",
            metavar="PAGE",
            help="take the latest step back: of `ground`, `adjust`, `check` or `lens CAMERA`",
        )
        parser.add_argument("--redo", metavar="PAGE", help="do it again")
        parser.add_argument("--kept-out", type=Path, metavar="FILE", help="write the kept points, CSV")
        parser.add_argument("--cameras-json", type=Path, metavar="FILE", help="write the cameras, metres")
        parser.add_argument("--zip", type=Path, metavar="FILE", help="write WILDTRACK's folder, centimetres")
        parser.add_argument("--remove", action="store_true", help="remove it with everything on it")
        parser.add_argument("--json", action="store_true", help="print one object per desk and line")

    def handle(self, *, desk: str | None, **options: Any) -> None:
        if desk is None:
            for each in Desk.objects.select_related("dataset"):
                self.tell(each, options["json"])
            return
        try:
            self.work(desk, options)
        except (DeskError, FormatError) as error:
            raise CommandError(str(error)) from error

    def work(self, slug: str, options: dict[str, Any]) -> None:
        found = self.made(slug, options) if options["new"] else desk_named(slug)
        if options["points"]:
            ground.put_file(found, read(options["points"]), options["points"].name, options["unit"])
        for camera, file in options["lens"]:
            lenses.put_file(found, camera, read(Path(file)), Path(file).name)
        for camera, file in options["picture"]:
            pictures.put(found, camera, read(Path(file)))
        for camera, file in options["clicks"]:
            ground.put_pairs(found, camera, read(Path(file)), Path(file).name, options["unit"])
        if options["kept"]:
            kept.put_file(found, read(options["kept"]), options["kept"].name, options["use"])
        desk_adjusting.work(found, options, self.stderr.write if options["json"] else self.stdout.write)
        if options["undo"]:
            edits.undo(found, options["undo"])
        if options["redo"]:
            edits.redo(found, options["redo"])
        if options["kept_out"]:
            write_bytes(options["kept_out"], kept.as_csv(found))
        desk_adjusting.write(found, options)
        if options["cameras_json"]:
            write_bytes(options["cameras_json"], placing.cameras_json(found))
        if options["zip"]:
            write_bytes(options["zip"], placing.folder_zip(found))
        if options["remove"]:
            desks.remove(found)
            return
        self.tell(found, options["json"])

    def made(self, slug: str, options: dict[str, Any]) -> Desk:
        dataset = dataset_named(options["dataset"]) if options["dataset"] else None
        return desks.make(slug, "", dataset, options["cameras"])

    def tell(self, desk: Desk, as_json: bool) -> None:
        found = overview.overview(desk)
        if as_json:
            self.stdout.write(json.dumps(facts(desk, found)))
            return
        where = f" for {desk.dataset.slug}" if desk.dataset else ""
        self.stdout.write(f"{desk.slug}{where}: {found.next_step.words}")
        for each in found.cameras:
            self.stdout.write(f"  {each.name:8} lens   {each.lens.verdict.value:11} {each.lens.words}")
            self.stdout.write(f"  {'':8} ground {each.ground.verdict.value:11} {each.ground.words}")
        self.stdout.write(f"  {'adjust':15} {found.adjust.verdict.value:11} {found.adjust.words}")
        check = checks.step(desk)
        self.stdout.write(f"  {'check':15} {check.verdict.value:11} {check.words}")


def facts(desk: Desk, found: overview.Overview) -> dict[str, Any]:
    cameras = [
        {
            "name": each.name,
            "lens": each.lens.verdict.value,
            "ground": each.ground.verdict.value,
            "rms": each.row.pose_report.get("rms"),
            "centre": each.row.pose_report.get("centre"),
        }
        for each in found.cameras
    ]
    dataset = desk.dataset.slug if desk.dataset else None
    checked = checks.whole(desk)
    return {
        "desk": desk.slug,
        "dataset": dataset,
        "points": found.points,
        "next_step": found.next_step.words,
        "cameras": cameras,
        "adjust": adjust_view.whole(desk),
        "kept": checked["kept"],
        "summaries": checked["summaries"],
    }


def desk_named(slug: str) -> Desk:
    found = Desk.objects.select_related("dataset").filter(slug=slug).first()
    if found is None:
        there = ", ".join(Desk.objects.values_list("slug", flat=True)) or "none"
        raise CommandError(f"no desk {slug}; there are: {there}")
    return found


def read(path: Path) -> bytes:
    return read_source(path.absolute(), MOST_BYTES)
