"""The import of annotations as a job, from what lies on the server or came through the browser."""

from __future__ import annotations

import zipfile
from collections.abc import Collection
from functools import partial
from pathlib import Path
from typing import Any
from uuid import uuid4

from django.conf import settings
from django.contrib.auth.models import User
from django.core.files.uploadedfile import UploadedFile
from django.utils.text import slugify

from gtm_hit.formats.files import replacing
from gtm_hit.formats.problems import FormatError
from gtm_hit.models import Dataset, Job, Layer
from gtm_hit.ops.datasets.importing import ImportFailed
from gtm_hit.ops.datasets.job import told
from gtm_hit.ops.files import sources
from gtm_hit.ops.jobs import queue
from gtm_hit.ops.jobs.progress import UNPACKING, WRITING, percents
from gtm_hit.ops.layers.findings import Kind
from gtm_hit.ops.layers.importing import TABLE, AnnotationSource, LayerReport, import_annotations
from gtm_hit.ops.layers.placing import PLACING
from gtm_hit.ops.layers.reading import READERS, READING

SHARES = {UNPACKING: (0, 10), READING: (10, 35), TABLE: (35, 40), PLACING: (40, 60), WRITING: (60, 100)}


class AnnotationImportError(queue.JobError):
    """What was asked for cannot be imported; says why."""


def start(
    dataset: Dataset,
    source: sources.Source,
    kind: str,
    layer: str,
    drop: Collection[Kind] = (),
    hidden: bool = False,
    user: User | None = None,
) -> Job:
    """Queue the import of a source's files as the format `kind`; the one under way when it is the same."""
    if kind not in READERS:
        raise AnnotationImportError(f"{kind} is not a format that can be imported.")
    if Layer.objects.filter(dataset=dataset, name=layer).exists():
        raise AnnotationImportError(f"The layer {layer} is there already; choose another name.")
    parameters = {
        "source": source.key,
        "format": kind,
        "layer": layer,
        "drop": sorted(drop),
        "hidden": hidden,
    }
    return queue.create_once(Job.Kind.IMPORT_ANNOTATIONS, dataset, parameters, user)


def keep(upload: UploadedFile) -> sources.Source:
    """Put an uploaded file among the sources, a single one in an archive of its own.

    Raises FormatError with all reasons when it cannot be kept.
    """
    name = Path(upload.name or "").name
    if name.lower().endswith(".zip"):
        return sources.keep(upload)
    stem = slugify(Path(name).stem)[:60] or "annotations"
    path = settings.UPLOADS_ROOT / f"{stem}-{uuid4().hex[:8]}.zip"
    with (
        replacing(path) as stream,
        zipfile.ZipFile(stream, "w", zipfile.ZIP_STORED) as archive,
        archive.open(f"{stem}.{slugify(Path(name).suffix)}", "w", force_zip64=True) as file,
    ):
        for chunk in upload.chunks():
            file.write(chunk)
    try:
        sources.checked_entries(path)
    except FormatError as error:
        path.unlink(missing_ok=True)
        raise error.relative_to(settings.UPLOADS_ROOT) from error
    return sources.Source(f"uploads/{path.name}", path)


def run(mine: queue.Run) -> dict[str, Any]:
    """The operation of an import job. A worker that takes it up again finds the layer it has made."""
    parameters = mine.job.parameters
    if mine.job.result:
        sources.let_go(parameters["source"], mine.job)
        return mine.job.result
    dataset, source = mine.job.dataset, sources.source(parameters["source"])
    if dataset is None or source is None:
        raise AnnotationImportError(f"{parameters['source']} is no longer there.")
    report = percents(mine, SHARES)

    def remember(found: LayerReport) -> None:
        # In the layer's own transaction: there is never one its job does not know of.
        mine.keep(result=_result(found))

    try:
        with sources.unpacked(source, mine.job, partial(report, UNPACKING)) as folder:
            wanted = AnnotationSource(
                folder,
                parameters["format"],
                parameters["layer"],
                parameters["hidden"],
                [Kind(name) for name in parameters["drop"]],
            )
            found = import_annotations(dataset, wanted, report, lambda: mine.confirm(100, 100), remember)
    except ImportFailed as error:
        raise AnnotationImportError(told(error.problems, "nothing was imported")) from error
    except FormatError as error:
        problems = error.relative_to(settings.UPLOADS_ROOT).problems
        raise AnnotationImportError(told(problems, "nothing was imported")) from error
    sources.let_go(source.key, mine.job)
    return _result(found)


def _result(found: LayerReport) -> dict[str, Any]:
    return {
        "layer": found.layer.name,
        "frames": found.frames,
        "people": found.people,
        "annotations": found.annotations,
        "dropped": found.dropped,
    }
