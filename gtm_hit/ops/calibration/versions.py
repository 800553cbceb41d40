"""The calibrations a dataset has had, by number, and which of them is in place."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from django.contrib.auth.models import User
from django.db.models import Max, QuerySet

from gtm_hit.formats.calibration.cameras_json import cameras_content, cameras_of, content_digest
from gtm_hit.geometry.camera import Camera
from gtm_hit.models import Calibration, CalibrationPlacement, Dataset
from gtm_hit.ops.errors import OperationError

IMPORTED = "import"
NOT_KNOWN = "in place before versions were kept"
SOURCE_LENGTH = 300


def gone_back(number: int) -> str:
    """The source of a calibration that the dataset had before."""
    return f"version {number}"


class UnknownVersion(OperationError, LookupError):
    """The dataset never had this version; says so."""

    def __init__(self, dataset: Dataset, number: int) -> None:
        super().__init__(f"{dataset} has no calibration {number}.")


def versions(dataset: Dataset) -> QuerySet[Calibration]:
    """The newest first; their cameras, which are long, are fetched when asked for."""
    found = Calibration.objects.filter(dataset=dataset).order_by("-number")
    return found.select_related("created_by", "dataset").defer("cameras")


def version(dataset: Dataset, number: int) -> Calibration:
    """Raises UnknownVersion."""
    found = versions(dataset).defer(None).filter(number=number).first()
    if found is None:
        raise UnknownVersion(dataset, number)
    return found


def in_place(dataset: Dataset) -> Calibration | None:
    """As the database has it now; None for a dataset without cameras."""
    pk = in_place_id(dataset.pk)
    return None if pk is None else Calibration.objects.get(pk=pk)


def in_place_id(dataset_id: int) -> int | None:
    return Dataset.objects.values_list("calibration_id", flat=True).get(pk=dataset_id)


def cameras_in(calibration: Calibration) -> list[Camera]:
    return cameras_of(calibration.cameras)


def put_in_place(
    dataset: Dataset,
    cameras: Sequence[Camera],
    source: str,
    user: User | None = None,
    report: dict[str, Any] | None = None,
) -> Calibration:
    """Give the cameras the dataset's next number, or the one they had before, and refer to them.

    `report`: what a desk knows of how they came about.

    The rows of `Camera` are the caller's business, and so is the lock on the dataset's row.
    """
    content = cameras_content(cameras)
    digest = content_digest(content)
    found = dataset.calibrations.filter(digest=digest).first()
    if found is None:
        last = dataset.calibrations.aggregate(last=Max("number"))["last"] or 0
        found = Calibration.objects.create(
            dataset=dataset,
            number=last + 1,
            cameras=content,
            digest=digest,
            source=source[:SOURCE_LENGTH],
            report=report or {},
            created_by=user,
        )
    elif report or found.pk != dataset.calibration_id:
        # A version never changes: what is known of it now is kept beside what was known first.
        CalibrationPlacement.objects.create(
            calibration=found, source=source[:SOURCE_LENGTH], report=report or {}, created_by=user
        )
    dataset.calibration = found
    dataset.save(update_fields=["calibration"])
    return found
