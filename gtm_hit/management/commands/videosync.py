"""Clocks of videos on the server: guess them, set them, take a step back, write them down."""

from __future__ import annotations

import json
from argparse import ArgumentParser
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from django.core.management.base import BaseCommand, CommandError

from gtm_hit.formats.files import write_bytes
from gtm_hit.management.progress import ProgressLine
from gtm_hit.models import VideoSync
from gtm_hit.ops.datasets.videos.options import SourceError, parse_source
from gtm_hit.ops.files import sources
from gtm_hit.ops.sync import drafts, job
from gtm_hit.ops.sync.guessing import SyncRefused
from gtm_hit.ops.sync.whole import whole


class Command(BaseCommand):
    help = (
        "List folders whose videos' clocks are put together, or open one of them. What is given is done in "
        "the order of the options below; then the offsets are printed."
    )

    def add_arguments(self, parser: ArgumentParser) -> None:
        parser.add_argument("source", nargs="?", help="a folder's name on the server, as incoming/plaza")
        parser.add_argument("--undo", action="store_true", help="take the latest change back")
        parser.add_argument("--redo", action="store_true", help="do it again")
        parser.add_argument("--guess", action="store_true", help="guess the offsets, and take them over")
        parser.add_argument(
            "--set",
            nargs="+",
            default=[],
            metavar="CAMERA=SECONDS",
            help="offset of a video, with its drift as in C1=12.4+35ppm",
        )
        parser.add_argument(
            "--output", type=Path, metavar="FILE", help="write them for importvideos --offsets"
        )
        parser.add_argument("--json", action="store_true", help="print one object per folder and line")

    def handle(self, *, source: str | None, **options: Any) -> None:
        if source is None:
            for each in VideoSync.objects.all():
                self.tell(each, options["json"])
            return
        found = sources.source(source)
        if found is None:
            there = ", ".join(each.key for each in sources.sources() if not each.is_archive) or "none"
            raise CommandError(f"there is no folder {source}; there are: {there}")
        try:
            draft = self.work(drafts.open_draft(found), options)
        except SyncRefused as error:
            raise CommandError(str(error)) from error
        if options["output"]:
            text = "".join(f"{line}\n" for line in whole(draft).lines)
            write_bytes(options["output"], text.encode())
        self.tell(draft, options["json"])

    def work(self, draft: VideoSync, options: dict[str, Any]) -> VideoSync:
        if options["undo"]:
            draft = drafts.undo(draft.pk, draft.revision)
        if options["redo"]:
            draft = drafts.redo(draft.pk, draft.revision)
        if options["guess"]:
            progress = ProgressLine(self.stderr)
            job.keep(draft, job.make_guess(draft, progress))
            progress.finish()
            draft = drafts.take_guess(draft.pk, draft.revision)
        if options["set"]:
            draft = drafts.save(draft.pk, draft.revision, with_offsets(drafts.current(draft), options["set"]))
        return draft

    def tell(self, draft: VideoSync, as_json: bool) -> None:
        found = whole(draft)
        if as_json:
            self.stdout.write(json.dumps(found.as_json()))
            return
        self.stdout.write(f"{found.source}, revision {found.revision}")
        if told := found.guess.get("told"):
            self.stdout.write(f"  First guess: {told}")
        for line in found.lines:
            self.stdout.write(f"  {line}")


def with_offsets(state: drafts.State, texts: list[str]) -> drafts.State:
    """Raises SyncRefused for what is no offset, or no camera of these."""
    for text in texts:
        camera, _, seconds = text.partition("=")
        try:
            wanted = parse_source(f"{camera}=video@{seconds}")
        except SourceError as error:
            raise SyncRefused(f"{text!r} does not read CAMERA=SECONDS: {error}.") from error
        if camera not in {clock.camera for clock in state.clocks}:
            raise SyncRefused(f"There is no camera {camera}.")
        moved = partial(replace, offset=wanted.offset, drift=wanted.drift)
        clocks = tuple(moved(clock) if clock.camera == camera else clock for clock in state.clocks)
        state = replace(state, clocks=clocks)
    return state
