"""A layer as files: a folder and a zip that appear complete or not at all.

Everything is made beside its final place, in a folder named by job and attempt, and renamed at the end.
"""

from __future__ import annotations

import hashlib
import re
import shutil
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from django.conf import settings
from django.contrib.auth.models import User

from gtm_hit.formats.files import sync, sync_tree
from gtm_hit.formats.manifest import FileEntry, Manifest, read_manifest
from gtm_hit.formats.problems import FormatError
from gtm_hit.formats.stable_zip import stable_zip
from gtm_hit.models import Job, Layer
from gtm_hit.ops.exports.folder import FRAMES, TABLE, ExportFolder
from gtm_hit.ops.exports.formats.registry import DEFAULT_FORMATS, chosen
from gtm_hit.ops.exports.formats.target import RECTANGLES
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.jobs.progress import Progress, percents

SHARES = {TABLE: (0, 5), FRAMES: (5, 85), RECTANGLES: (85, 100)}
PARTIAL = re.compile(r".+\.partial-(?P<job>\d+)-(?P<attempt>\d+)")


class ExportError(queue.JobError):
    """The layer cannot be exported, or not to there."""


@dataclass(frozen=True)
class Export:
    """A finished export on this server's disk."""

    folder: Path
    archive: Path
    archive_name: str
    files: list[tuple[str, FileEntry]]

    @property
    def archive_bytes(self) -> int:
        return self.archive.stat().st_size


def start(layer: Layer, user: User | None = None, formats: Collection[str] = DEFAULT_FORMATS) -> Job:
    """Queue the export of a layer; the one under way when there is one. ValueError for unknown formats."""
    parameters = {"layer": layer.name, "layer_id": layer.pk, "formats": chosen(formats)}
    return queue.create_once(Job.Kind.EXPORT_LAYER, layer.dataset, parameters, user)


def run(mine: queue.Run) -> dict[str, Any]:
    """The operation of an export job; its result goes onto the job's row."""
    layer = Layer.objects.select_related("dataset").filter(pk=mine.job.parameters["layer_id"]).first()
    if layer is None:
        raise ExportError("The layer is no longer there.")
    folder = settings.EXPORTS_ROOT / f"{layer.dataset.slug}-{layer.name}-{mine.job.pk}"
    partial = folder.with_name(f"{folder.name}.partial-{mine.job.pk}-{mine.attempt}")

    manifest = export_layer(
        layer,
        folder,
        partial,
        percents(mine, SHARES),
        lambda: mine.holding(100, 100),
        mine.job.parameters.get("formats", DEFAULT_FORMATS),
    )
    return {
        "folder": folder.name,
        "archive_name": f"{archive_root(layer)}.zip",
        "sha256": sha256(archive_of(folder)),
        "counts": dict(manifest.counts),
    }


def export_layer(
    layer: Layer,
    folder: Path,
    partial: Path,
    report: Progress,
    holding: Callable[[], AbstractContextManager[None]] = nullcontext,
    formats: Collection[str] = DEFAULT_FORMATS,
) -> Manifest:
    """Write a layer to `folder` and to the zip beside it, replacing an earlier export there.

    `partial` is the folder for unfinished work, on the same disk; it is gone afterwards, whatever happens.
    The renames are made while `holding`; what it raises before leaves everything as it was.
    """
    with empty_folder(partial):
        content, archive = partial / "content", partial / "content.zip"
        content.mkdir()
        with stable_zip(archive, archive_root(layer)) as packed:
            manifest = ExportFolder(content, packed, layer, report, chosen(formats)).write()
        if not manifest.counts["frames"]:
            raise ExportError(f"Nothing has been saved in the layer {layer.name} yet.")
        sync_tree(content)
        with holding():
            rename_all([(content, folder), (archive, archive_of(folder))], partial / "before")
    return manifest


def archive_root(layer: Layer) -> str:
    """The folder inside the zip; without the job's number, so that equal layers give equal zips."""
    return f"{layer.dataset.slug}-{layer.name}"


def archive_of(folder: Path) -> Path:
    return folder.with_name(f"{folder.name}.zip")


@contextmanager
def empty_folder(path: Path) -> Iterator[None]:
    shutil.rmtree(path, ignore_errors=True)
    path.mkdir(parents=True)
    try:
        yield
    finally:
        shutil.rmtree(path, ignore_errors=True)


def rename_all(wanted: Sequence[tuple[Path, Path]], aside: Path) -> None:
    """Give files and folders (now, then) names that may be taken: all of them, or none when a rename fails.

    What has the names so far goes to the folder `aside`: a folder cannot be replaced in one step like a file.
    The names are on the disk afterwards; what they name should be before.
    """
    aside.mkdir()
    renamed: list[tuple[Path, Path]] = []
    try:
        for number, (source, target) in enumerate(wanted):
            if target.exists():
                target.replace(aside / str(number))
                renamed.append((target, aside / str(number)))
            source.replace(target)
            renamed.append((source, target))
    except BaseException:
        for before, now in reversed(renamed):
            now.replace(before)
        raise
    for folder in {target.parent for _source, target in wanted}:
        sync(folder)


def require_replaceable(folder: Path) -> None:
    """Refuse a folder that holds anything but an earlier export."""
    if not folder.exists() or (folder.is_dir() and not any(folder.iterdir())):
        return
    try:
        read_manifest(folder)
    except (FormatError, OSError):
        raise ExportError(f"{folder} is not empty and holds no export; choose another folder.") from None


def remove_dead_partials() -> None:
    """Remove unfinished work of jobs whose worker was killed."""
    if not settings.EXPORTS_ROOT.is_dir():
        return
    found = [
        (path, (int(match["job"]), int(match["attempt"])))
        for path in settings.EXPORTS_ROOT.iterdir()
        if (match := PARTIAL.fullmatch(path.name))
    ]
    if not found:
        return
    alive = set(Job.objects.filter(state=Job.State.RUNNING).values_list("pk", "attempts"))
    for path, owner in found:
        if owner not in alive:
            shutil.rmtree(path, ignore_errors=True)


def made_files(job: Job) -> bool:
    """Whether there is something to download, as far as the row knows."""
    return job.state == Job.State.DONE and "folder" in job.result and not job.result.get("removed")


def finished(job: Job) -> Export | None:
    """The files of an export job that is done, or None when they are not (or no longer) there."""
    if not made_files(job):
        return None
    folder = settings.EXPORTS_ROOT / job.result["folder"]
    archive = archive_of(folder)
    try:
        manifest = read_manifest(folder)
    except FormatError:
        return None
    if not archive.is_file():
        return None
    return Export(folder, archive, job.result["archive_name"], sorted(manifest.files.items()))


def sha256(path: Path) -> str:
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
