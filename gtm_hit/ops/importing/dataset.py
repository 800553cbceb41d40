"""The import itself: read and check everything, then derive, then write it in one transaction."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

from django.conf import settings
from django.core.exceptions import ValidationError
from django.db import IntegrityError, transaction

from gtm_hit.formats.layout import Layout, find_layout
from gtm_hit.formats.problems import FormatError, Problem, ProblemList
from gtm_hit.geometry.camera import Camera as CalibratedCamera
from gtm_hit.geometry.table import RectangleTable
from gtm_hit.models import Dataset, Image, Layer, LayerFrame
from gtm_hit.ops import grid_files
from gtm_hit.ops.images import Derivatives
from gtm_hit.ops.importing import rows
from gtm_hit.ops.importing.annotations import ImportedFrame, compare_boxes, ignored_sizes, read_annotations
from gtm_hit.ops.importing.calibrations import View, read_views, tell_differences, tell_wrong_unit
from gtm_hit.ops.importing.options import PRESETS, ImportOptions, scene
from gtm_hit.ops.importing.pictures import Key, Picture, camera_sizes, discard, make_pictures

Progress = Callable[[str, int, int], None]
"""Phase in words, steps done, steps in all."""


class ImportFailed(Exception):
    """Nothing was imported; `problems` says why, file by file."""

    def __init__(self, problems: tuple[Problem, ...]) -> None:
        super().__init__("\n".join(str(problem) for problem in problems))
        self.problems = problems


@dataclass(frozen=True)
class ImportReport:
    """What a run added; `notes` are sentences about what was noticed and is no error."""

    dataset: Dataset
    layer: Layer | None
    frames_added: int
    images_added: int
    annotated_frames_added: int
    people_added: int
    notes: list[str] = field(default_factory=list)


@dataclass(eq=False)
class Reading:
    """Everything one run has read so far."""

    options: ImportOptions
    existing: Dataset | None
    dataset: Dataset
    layout: Layout
    views: list[View]
    layer: Layer | None
    known_images: dict[Key, str]  # digests of the files imported before
    numbers: list[int]  # frames to add
    imported: list[ImportedFrame]
    notes: list[str]

    @property
    def cameras(self) -> list[CalibratedCamera]:
        return [view.camera for view in self.views]


def no_progress(_phase: str, _done: int, _total: int) -> None:
    pass


def import_dataset(options: ImportOptions, progress: Progress = no_progress) -> ImportReport:
    """Import what is new in a folder, or nothing at all.

    Raises ImportFailed with all problems of the run. Files of derivatives it made are deleted again then;
    the database is written in one transaction at the end.
    """
    problems = ProblemList("")
    written: set[str] = set()
    try:
        reading = _read(options, progress, problems)
        made = _make(reading, written, progress, problems)
        progress("writing to the database", 0, 1)
        report = _write(reading, made)
        progress("writing to the database", 1, 1)
        return report
    except BaseException as error:
        discard(written)
        if isinstance(error, FormatError):
            raise ImportFailed(error.relative_to(options.folder.resolve()).problems) from error
        if isinstance(error, IntegrityError):
            reason = "was changed by another import in the meantime; run this one again"
            raise ImportFailed((Problem(options.slug, "", reason),)) from error
        if isinstance(error, OSError):
            problem = Problem(str(error.filename or ""), "", error.strerror or type(error).__name__)
            raise ImportFailed((problem,)) from error
        raise


def _read(options: ImportOptions, progress: Progress, problems: ProblemList) -> Reading:
    if not options.folder.is_dir():
        problems.add("options", f"no such folder: {options.folder}")
    existing = Dataset.objects.filter(slug=options.slug).first()
    dataset = scene(options, existing, problems)
    layer = _existing_layer(options, existing, problems)
    # Files are not worth reading for a grid nobody has told.
    problems.raise_if_any()
    layout = _layout(options, existing, dataset, problems)
    progress("reading image headers", 0, 1)
    known = list(existing.cameras.all()) if existing else []
    sizes = camera_sizes(layout.images, {row.name: (row.width, row.height) for row in known}, problems)
    progress("reading image headers", 1, 1)
    views = read_views(layout, sizes, options.unit, options.undistort, problems)
    cameras = [view.camera for view in views]
    if len(cameras) == len(layout.cameras):
        if existing is not None:
            tell_differences(cameras, known, options.unit, problems)
        else:
            tell_wrong_unit(cameras, dataset.grid, options.unit, problems)
    known_images = _known_images(existing)
    notes: list[str] = []
    numbers = _new_numbers(options, dataset, layout, known_images, notes)
    return Reading(
        options=options,
        existing=existing,
        dataset=dataset,
        layout=layout,
        views=views,
        layer=layer,
        known_images=known_images,
        numbers=numbers,
        imported=_annotations(dataset, layout, layer, progress, problems, notes),
        notes=notes,
    )


def _existing_layer(options: ImportOptions, existing: Dataset | None, problems: ProblemList) -> Layer | None:
    layer = Layer.objects.filter(dataset=existing, name=options.layer).first() if existing else None
    if layer is not None:
        if layer.kind != options.layer_kind:
            reason = f"is {layer.get_kind_display()}: choose another name with --layer"
            problems.add("options", f"layer {layer.name} {reason}")
        return layer
    try:
        Layer(name=options.layer, kind=options.layer_kind).clean_fields(exclude=["dataset"])
    except ValidationError as error:
        problems.add("options", f"layer: {' '.join(error.messages)}")
    return None


def _layout(
    options: ImportOptions, existing: Dataset | None, dataset: Dataset, problems: ProblemList
) -> Layout:
    """The files; fills in what only their names say about annotation files."""
    preset = PRESETS[options.preset].values if options.preset else {}
    told = existing is not None or "annotation_offset" in {**preset, **options.values}
    layout = find_layout(
        options.folder,
        images=options.images,
        annotation_offset=dataset.annotation_offset if told else None,
        calibrations=options.calibrations,
        annotations=options.annotations,
        problems=problems,
    )
    dataset.annotation_offset = layout.annotation_offset
    if existing is None and layout.annotations and "annotation_digits" not in {**preset, **options.values}:
        dataset.annotation_digits = len(next(iter(layout.annotations.values())).stem)
    return layout


def _known_images(existing: Dataset | None) -> dict[Key, str]:
    if existing is None:
        return {}
    found = Image.objects.filter(frame__dataset=existing)
    return {
        (camera, number): digest
        for camera, number, digest in found.values_list("camera__index", "frame__number", "source_digest")
    }


def _new_numbers(
    options: ImportOptions,
    dataset: Dataset,
    layout: Layout,
    known_images: Mapping[Key, str],
    notes: list[str],
) -> list[int]:
    """Frames to add: every n-th, and whatever has annotations."""
    there = {number for _camera, number in known_images}
    numbers = sorted(set().union(*layout.images.values()))
    new = [number for number in numbers if number not in there]
    if options.keep_all_frames or not numbers:
        return new
    first = min(there or numbers)
    kept = [
        number for number in new if (number - first) % dataset.frame_step == 0 or number in layout.annotations
    ]
    if len(kept) < len(new):
        notes.append(
            f"{len(new) - len(kept)} frames lie between every {dataset.frame_step}th and were left out "
            "(--keep-all-frames takes them)"
        )
    return kept


def _annotations(
    dataset: Dataset,
    layout: Layout,
    layer: Layer | None,
    progress: Progress,
    problems: ProblemList,
    notes: list[str],
) -> list[ImportedFrame]:
    paths = dict(layout.annotations)
    if layer is not None:
        there = LayerFrame.objects.filter(layer=layer, revision__gt=0)
        known = set(there.values_list("frame__number", flat=True)) & paths.keys()
        paths = {number: path for number, path in paths.items() if number not in known}
        if known:
            notes.append(f"{len(known)} annotation files are in layer {layer.name} already")
    frames = read_annotations(
        paths,
        dataset,
        len(layout.cameras),
        lambda done, total: progress("reading annotations", done, total),
        problems,
    )
    if ignored := ignored_sizes(frames):
        notes.append(f"height or radius of {ignored} people is not in metres and was ignored")
    return frames


def _make(
    reading: Reading, written: set[str], progress: Progress, problems: ProblemList
) -> dict[Key, Derivatives]:
    """The table and the derivatives; with problems so far, images are only checked, to tell all at once."""
    only_check = bool(problems)
    if not only_check:
        _make_table(reading, progress, problems)
    wanted = {*reading.numbers, *(number for _camera, number in reading.known_images)}
    told = {problem.path for problem in problems.found}
    undistorts = {view.camera.name: view.undistort for view in reading.views}
    pictures = [
        Picture((index, number), path, undistorts.get(name), reading.known_images.get((index, number)))
        for index, name in enumerate(reading.layout.cameras)
        for number, path in reading.layout.images[name].items()
        if number in wanted and str(path) not in told
    ]
    # By frame: all views of one instant are close together on most disks, and so are their derivatives.
    pictures.sort(key=lambda picture: (picture.key[1], picture.key[0]))
    phase = "checking images" if only_check else "making images"
    made = make_pictures(
        pictures, written, lambda done, total: progress(phase, done, total), problems, only_check
    )
    problems.raise_if_any()
    return made


def _make_table(reading: Reading, progress: Progress, problems: ProblemList) -> None:
    dataset, cameras = reading.dataset, reading.cameras
    table = RectangleTable.build(
        Path(settings.TABLES_ROOT),
        cameras,
        dataset.grid,
        dataset.cylinder,
        dataset.rule,
        lambda done, total: progress("computing rectangles", done, total),
    )
    dataset.table_digest = table.digest
    grid_files.make(dataset, table, cameras)
    blind = [camera.name for camera in cameras if not table.visible(camera.index).any()]
    if len(blind) == len(cameras):
        problems.add("calibrations", "no camera sees any position: grid, origin or --tvec-unit is wrong")
    elif blind:
        reading.notes.append(f"no position is visible in {', '.join(blind)}")
    different, total = compare_boxes(reading.imported, table, cameras, dataset.rule, dataset.cylinder)
    if different:
        reading.notes.append(
            f"{different} of {total} boxes in the annotation files differ from the computed ones, "
            "which are used"
        )


def _write(reading: Reading, made: Mapping[Key, Derivatives]) -> ImportReport:
    options = reading.options
    with transaction.atomic():
        dataset = _write_dataset(reading)
        rows.add_frames(dataset, reading.numbers, made)
        layer = reading.layer
        if reading.imported:
            if layer is None:
                layer = Layer.objects.create(
                    dataset=dataset, name=options.layer, kind=options.layer_kind, hidden=options.hidden_layer
                )
            rows.add_annotations(layer, reading.imported)
    return ImportReport(
        dataset=dataset,
        layer=layer,
        frames_added=len(reading.numbers),
        images_added=len(made),
        annotated_frames_added=len(reading.imported),
        people_added=sum(len(frame.rows) for frame in reading.imported),
        notes=reading.notes,
    )


def _write_dataset(reading: Reading) -> Dataset:
    if reading.existing is None:
        reading.dataset.save(force_insert=True)
        rows.add_cameras(reading.dataset, reading.cameras)
        return reading.dataset
    dataset = Dataset.objects.select_for_update().get(pk=reading.existing.pk)
    # A table may have been made anew by a newer version of the rule.
    dataset.table_digest = reading.dataset.table_digest
    dataset.save(update_fields=["table_digest"])
    return dataset
