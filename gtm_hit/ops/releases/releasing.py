"""Numbered exports that never change: made complete, then given their number and name in one step."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from django.conf import settings
from django.contrib.auth.models import User
from django.db import transaction
from django.db.models import F, QuerySet

from gtm_hit.formats.files import make_folder, sync_tree
from gtm_hit.formats.manifest import Manifest, manifest_json
from gtm_hit.formats.stable_zip import StableZip, stable_zip
from gtm_hit.models import Calibration, Dataset, Job, Layer, Release
from gtm_hit.ops.calibration.versions import in_place
from gtm_hit.ops.exports import exporting
from gtm_hit.ops.exports.folder import FRAMES, TABLE, ExportFolder
from gtm_hit.ops.exports.formats.registry import chosen
from gtm_hit.ops.exports.formats.target import RECTANGLES
from gtm_hit.ops.exports.sources import SOURCES
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.jobs.progress import Progress, percents
from gtm_hit.ops.quality.layer_rows import state_of
from gtm_hit.ops.quality.statistics.figures import FIGURES, figure
from gtm_hit.ops.quality.statistics.measuring import (
    ground_coverage,
    layer_statistics,
    unmeasurable,
)
from gtm_hit.ops.releases.changes import CHANGES, write_changes
from gtm_hit.ops.releases.provenance import PROVENANCE, ProvenanceWriter
from gtm_hit.ops.releases.readme import readme

FORMATS = ("wildtrack", "mot", "coco", "csv", "text")  # unless others are chosen
MEASURING = "measuring"
SHARES = {
    TABLE: (0, 5),
    FRAMES: (5, 80),
    RECTANGLES: (80, 90),
    MEASURING: (90, 100),
}
PARTS = (
    "README.md",
    "LICENSE",
    CHANGES,
    PROVENANCE,
    SOURCES,
    "manifest.json",
)  # worth having without the rest
MOST_LICENCE = 100_000  # characters


class ReleaseError(exporting.ExportError):
    """The layer cannot be released; says why."""


@dataclass(frozen=True)
class Order:
    layer: Layer
    licence: str
    title: str = ""
    formats: Sequence[str] = FORMATS
    user: User | None = None


def start(order: Order) -> Job:
    """Queue a release; the one under way when it is the same. ReleaseError for what cannot be released."""
    check(order)
    parameters = {
        "layer": order.layer.name,
        "layer_id": order.layer.pk,
        "title": order.title,
        "licence": order.licence,
        "formats": list(order.formats),
    }
    return queue.create_once(Job.Kind.MAKE_RELEASE, order.layer.dataset, parameters, order.user)


def run(mine: queue.Run) -> dict[str, Any]:
    """The operation of a release job. A worker that takes it up again makes no second release."""
    if mine.job.result:
        return mine.job.result
    parameters = mine.job.parameters
    layer = Layer.objects.select_related("dataset").filter(pk=parameters["layer_id"]).first()
    if layer is None:
        raise ReleaseError("The layer is no longer there.")
    order = Order(
        layer, parameters["licence"], parameters["title"], parameters["formats"], mine.job.created_by
    )
    partial = settings.EXPORTS_ROOT / f"release.partial-{mine.job.pk}-{mine.attempt}"

    def remember(release: Release) -> None:
        # In the release's own transaction: there is never one its job does not know of.
        mine.keep(result=_result(release))

    release = make_release(
        order,
        partial,
        percents(mine, SHARES),
        lambda: mine.confirm(100, 100),
        remember,
    )
    return _result(release)


def make_release(
    order: Order,
    partial: Path,
    report: Progress,
    confirm: Callable[[], None] | None = None,
    remember: Callable[[Release], None] | None = None,
) -> Release:
    """Write the layer under the dataset's next number.

    `partial` is the folder for unfinished work, on the same disk; it is gone afterwards, whatever happens.
    Raises ReleaseError when the layer is empty or changes meanwhile, or when somebody else takes the number.
    """
    check(order)
    dataset = order.layer.dataset
    before = releases(dataset).first()
    number = before.number + 1 if before else 1
    with exporting.empty_folder(partial):
        content, archive = partial / "content", partial / "content.zip"
        content.mkdir()
        with stable_zip(archive, f"{dataset.slug}-release-{number}") as packed:
            manifest, calibration = _write(order, content, packed, number, before, report)
        _protect(content)
        sync_tree(content)  # not while the row's transaction keeps others waiting
        if confirm:
            confirm()
        with transaction.atomic():
            Dataset.objects.select_for_update().get(pk=dataset.pk)
            if Release.objects.filter(dataset=dataset, number__gte=number).exists():
                raise ReleaseError(f"Release {number} was made by somebody else meanwhile; start again.")
            release = _row(order, number, manifest, calibration)
            if remember:
                remember(release)
            target = folder_of(release)
            make_folder(target.parent)
            # Without a row there can only be what a power cut left.
            exporting.rename_all([(content, target), (archive, archive_of(release))], partial / "before")
    return release


def check(order: Order) -> None:
    try:
        chosen(order.formats)
    except ValueError as error:
        raise ReleaseError(str(error)) from error
    if reason := unmeasurable(order.layer.dataset):
        raise ReleaseError(reason)
    if not order.licence.strip():
        raise ReleaseError("A release needs a licence text.")
    if len(order.licence) > MOST_LICENCE:
        raise ReleaseError(f"The licence text has more than {MOST_LICENCE} characters.")
    if len(order.title) > 200:
        raise ReleaseError("The title has more than 200 characters.")


def releases(dataset: Dataset) -> QuerySet[Release]:
    """The newest first, with `counts` out of their manifests, which are long."""
    found = Release.objects.filter(dataset=dataset).order_by("-number")
    return (
        found.select_related("dataset", "layer", "created_by", "calibration")
        .defer("manifest", "calibration__cameras")
        .annotate(counts=F("manifest__counts"))
    )


def folder_of(release: Release) -> Path:
    return settings.RELEASES_ROOT / release.dataset.slug / str(release.number)


def archive_of(release: Release) -> Path:
    return folder_of(release).with_name(f"{release.dataset.slug}-release-{release.number}.zip")


def part_of(release: Release, name: str) -> Path | None:
    """One of PARTS on this server's disk."""
    path = folder_of(release) / name
    return path if name in PARTS and path.is_file() else None


def text_of(release: Release, name: str) -> str:
    """A part's text; empty where the release's files are not on this server."""
    path = part_of(release, name)
    return path.read_text(encoding="utf-8") if path else ""


def figure_of(release: Release, name: str) -> str:
    path = folder_of(release) / "figures" / f"{name}.svg"
    return path.read_text(encoding="utf-8") if path.is_file() else ""


def _write(
    order: Order, content: Path, packed: StableZip, number: int, before: Release | None, report: Progress
) -> tuple[Manifest, Calibration | None]:
    layer, dataset = order.layer, order.layer.dataset
    state = state_of(layer)
    export = ExportFolder(content, packed, layer, report, chosen(order.formats), more=[ProvenanceWriter])
    export.write_layer()
    if not export.frames:
        raise ReleaseError(f"Nothing has been saved in the layer {layer.name} yet.")
    files = export.files
    since = before.number if before else None
    with files.stream(CHANGES) as stream:
        old = folder_of(before) / PROVENANCE if before else None
        changes = write_changes(stream, since, old, content / PROVENANCE)
    found, ground = layer_statistics(layer), ground_coverage(dataset)
    for done, name in enumerate(FIGURES, start=1):
        files.write(f"figures/{name}.svg", figure(name, found, ground).encode())
        report(MEASURING, done, len(FIGURES))
    files.write("LICENSE", (order.licence.strip() + "\n").encode())
    words = readme(order.title, number, export.readme(), found, ground, changes, since, FIGURES)
    files.write("README.md", words.encode())
    if state_of(layer) != state:
        raise ReleaseError(f"The layer {layer.name} was changed while it was released; start again.")
    # The statistics and their figures read the cameras for themselves.
    if in_place(dataset) != export.calibration:
        raise ReleaseError("The calibration was replaced while the layer was released; start again.")
    manifest = export.seal(release=number, title=order.title, since=since, changes=changes)
    return manifest, export.calibration


def _protect(folder: Path) -> None:
    for path in folder.rglob("*"):
        if path.is_file():
            path.chmod(0o444)


def _row(order: Order, number: int, manifest: Manifest, calibration: Calibration | None) -> Release:
    data = manifest_json(manifest)
    return Release.objects.create(
        dataset=order.layer.dataset,
        number=number,
        layer=order.layer,
        title=order.title,
        calibration=calibration,
        manifest=json.loads(data),
        manifest_digest=hashlib.sha256(data).hexdigest(),
        created_by=order.user,
    )


def _result(release: Release) -> dict[str, Any]:
    return {
        "release": release.number,
        "counts": release.manifest["counts"],
        "sha256": release.manifest_digest,
    }
