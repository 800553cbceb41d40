"""The import itself: read and check everything, then derive, then write it in one transaction."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

from django.conf import settings
from django.core.exceptions import ValidationError
from django.db import IntegrityError, transaction

from gtm_hit.formats.layout import Layout, find_layout
from gtm_hit.formats.problems import FormatError, Problem, ProblemList
from gtm_hit.geometry.camera import Camera as CalibratedCamera
from gtm_hit.geometry.table import RectangleTable
from gtm_hit.models import Dataset, Frame, Image, Layer, LayerFrame
from gtm_hit.ops.calibration import versions
from gtm_hit.ops.calibration.cameras import View, read_views, tell_differences, tell_wrong_unit
from gtm_hit.ops.datasets import rows
from gtm_hit.ops.datasets.annotations import ImportedFrame, compare_boxes, read_annotations
from gtm_hit.ops.datasets.options import PRESETS, ImportOptions, scene, tell_too_many
from gtm_hit.ops.datasets.pictures import Key, Known, Picture, camera_sizes, make_pictures
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.files.images import MOST_PIXELS, Derivatives
from gtm_hit.ops.files.picture_cleanup import pictures_in_use
from gtm_hit.ops.ground import grid_files
from gtm_hit.ops.jobs.progress import WRITING, Progress, no_progress
from gtm_hit.ops.proposals import job as proposals

FRAMES_AT_ONCE = 500  # in one question to the database


class ImportFailed(OperationError):
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
    known_images: dict[Key, Known]
    numbers: list[int]  # frames to add
    imported: list[ImportedFrame]
    notes: list[str]

    @property
    def cameras(self) -> list[CalibratedCamera]:
        return [view.camera for view in self.views]


def import_dataset(
    options: ImportOptions,
    progress: Progress = no_progress,
    remember: Callable[[ImportReport], object] | None = None,
) -> ImportReport:
    """Import what is new in a folder, or nothing at all.

    Raises ImportFailed with all problems of the run. The database is written in one transaction at the end,
    in which `remember` is told. Derivatives of a failed run stay: another one may have found them there and
    count on them. `picture_cleanup` removes later what nobody uses.
    """
    problems = ProblemList("")
    try:
        with pictures_in_use():
            reading = _read(options, progress, problems)
            made = _make(reading, progress, problems)
            progress(WRITING, 0, 1)
            report = _write(reading, made, remember)
            progress(WRITING, 1, 1)
            return report
    except BaseException as error:
        if isinstance(error, FormatError):
            raise ImportFailed(error.relative_to(options.folder).problems) from error
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
    files = layout.calibrations
    views = read_views(files, layout.cameras, sizes, options.unit, options.undistort, problems, options.alpha)
    cameras = [view.camera for view in views]
    tell_too_many(dataset, len(layout.cameras), problems)
    if len(cameras) == len(layout.cameras):
        if existing is not None:
            tell_differences(cameras, known, options.unit, problems)
        else:
            tell_wrong_unit(cameras, dataset.grid, options.unit, problems)
    known_images = _known_images(existing, sorted(set().union(*layout.images.values())))
    notes: list[str] = []
    numbers = _new_numbers(options, dataset, layout, _known_numbers(existing), notes)
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
        problems,
        images=options.images,
        annotation_offset=dataset.annotation_offset if told else None,
        calibrations=options.calibrations,
        annotations=options.annotations,
    )
    dataset.annotation_offset = layout.annotation_offset
    if existing is None and layout.annotations and "annotation_digits" not in {**preset, **options.values}:
        dataset.annotation_digits = len(next(iter(layout.annotations.values())).stem)
    return layout


def _known_images(existing: Dataset | None, numbers: Sequence[int]) -> dict[Key, Known]:
    """Of these frames alone: videos come in some instants at a time, into what may be hours already."""
    digests = ("source_digest", "light_digest", "full_digest")
    known: dict[Key, Known] = {}
    for start in range(0, len(numbers) if existing else 0, FRAMES_AT_ONCE):
        these = numbers[start : start + FRAMES_AT_ONCE]
        found = Image.objects.filter(frame__dataset=existing, frame__number__in=these)
        for camera, number, *made in found.values_list("camera__index", "frame__number", *digests):
            known[camera, number] = Known(*made)
    return known


def _known_numbers(existing: Dataset | None) -> set[int]:
    """Of the dataset's frames; a number is a hundredth of what the digests of its images are."""
    return set(Frame.objects.filter(dataset=existing).values_list("number", flat=True)) if existing else set()


def _new_numbers(
    options: ImportOptions,
    dataset: Dataset,
    layout: Layout,
    there: Collection[int],
    notes: list[str],
) -> list[int]:
    """Frames to add: every n-th, and whatever has annotations."""
    numbers = sorted(set().union(*layout.images.values()))
    new = [number for number in numbers if number not in there]
    if options.keep_all_frames or not numbers:
        return new
    first = min(there or numbers)
    kept = [
        number for number in new if (number - first) % dataset.frame_step == 0 or number in layout.annotations
    ]
    if len(kept) < len(new):
        left = len(new) - len(kept)
        told = "1 frame lies" if left == 1 else f"{left} frames lie"
        notes.append(
            f"{told} between every {dataset.frame_step}th and "
            f"{'was' if left == 1 else 'were'} left out (--keep-all-frames takes them)"
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
    found = read_annotations(
        paths,
        dataset,
        len(layout.cameras),
        partial(progress, "reading annotations"),
        problems,
    )
    if found.ignored_sizes:
        notes.append(f"height or radius of {found.ignored_sizes} people is not in metres and was ignored")
    return found.frames


def _make(reading: Reading, progress: Progress, problems: ProblemList) -> dict[Key, Derivatives]:
    """The table and the derivatives; with problems so far, images are only checked, to tell all at once."""
    only_check = bool(problems)
    if not only_check:
        _make_table(reading, progress, problems)
    wanted = {*reading.numbers, *(number for _camera, number in reading.known_images)}
    told = {problem.path for problem in problems.found}
    views = {view.camera.name: view for view in reading.views}
    pictures = [
        _picture((index, number), path, views.get(name), reading.known_images)
        for index, name in enumerate(reading.layout.cameras)
        for number, path in reading.layout.images[name].items()
        if number in wanted and str(path) not in told
    ]
    # By frame: all views of one instant are close together on most disks, and so are their derivatives.
    pictures.sort(key=lambda picture: (picture.key[1], picture.key[0]))
    phase = "checking images" if only_check else "making images"
    made = make_pictures(pictures, partial(progress, phase), problems, only_check)
    problems.raise_if_any()
    return made


def _picture(key: Key, path: Path, view: View | None, known_images: Mapping[Key, Known]) -> Picture:
    known = known_images.get(key)
    if view is None:
        return Picture(key, path, MOST_PIXELS, known=known)
    return Picture(key, path, view.camera.width * view.camera.height, view.undistort, known)


def _make_table(reading: Reading, progress: Progress, problems: ProblemList) -> None:
    dataset, cameras = reading.dataset, reading.cameras
    table = RectangleTable.build(
        Path(settings.TABLES_ROOT),
        cameras,
        dataset.grid,
        dataset.cylinder,
        dataset.rule,
        partial(progress, "computing rectangles"),
    )
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


def _write(
    reading: Reading,
    made: Mapping[Key, Derivatives],
    remember: Callable[[ImportReport], object] | None,
) -> ImportReport:
    options = reading.options
    with transaction.atomic():
        dataset = _write_dataset(reading)
        rows.add_frames(dataset, reading.numbers, made)
        rows.mend_images(dataset, {key: made[key] for key in made.keys() & reading.known_images.keys()})
        layer = reading.layer
        if reading.imported:
            if layer is None:
                layer = Layer.objects.create(
                    dataset=dataset, name=options.layer, kind=options.layer_kind, hidden=options.hidden_layer
                )
            rows.add_annotations(layer, reading.imported)
        report = ImportReport(
            dataset=dataset,
            layer=layer,
            frames_added=len(reading.numbers),
            images_added=len(made.keys() - reading.known_images.keys()),
            annotated_frames_added=len(reading.imported),
            people_added=sum(map(len, reading.imported)),
            notes=reading.notes,
        )
        if remember:
            remember(report)
        if reading.numbers:
            proposals.start_by_itself(dataset)
    return report


def _write_dataset(reading: Reading) -> Dataset:
    if reading.existing is None:
        reading.dataset.save(force_insert=True)
        rows.add_cameras(reading.dataset, reading.cameras)
        versions.put_in_place(reading.dataset, reading.cameras, versions.IMPORTED)
        return reading.dataset
    return Dataset.objects.select_for_update().get(pk=reading.existing.pk)
