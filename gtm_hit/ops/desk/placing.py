"""From a desk to where its calibration is used: compared and put in place, or files for an import."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from django.conf import settings
from django.contrib.auth.models import User

from gtm_hit.formats.calibration.cameras_json import cameras_content
from gtm_hit.formats.files import write_bytes
from gtm_hit.formats.stable_zip import stable_zip
from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import FootRule
from gtm_hit.models import Desk, DeskCamera, Job
from gtm_hit.ops.calibration import job as calibration_job
from gtm_hit.ops.desk import adjust_results, overview, poses
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.exports.calibrations import calibration_files

FIGURES = ("verdict", "rms", "holdout_rms", "sigma", "model", "inputs")
README = """The calibration of desk {slug}, laid out as WILDTRACK publishes its own.

tvec in extrinsic/ is in centimetres (import it with --tvec-unit cm), rvec in radians; both world to camera.
The pictures are as they were taken: their lens is in the intrinsic files.
"""


def cameras(desk: Desk) -> list[Camera]:
    """All of them. Raises DeskError that names those something is missing of."""
    rows = list(desk.cameras.order_by("index"))
    if not rows:
        raise DeskError("The desk has no cameras yet.")
    made = [poses.calibrated(row) for row in rows]
    unseen = [row.name for row in rows if row.lens is None]
    unplaced = [row.name for row, camera in zip(rows, made, strict=True) if row.lens and camera is None]
    if unseen or unplaced:
        parts = ((unseen, "No lens yet"), (unplaced, "No place on the ground yet"))
        raise DeskError(" ".join(f"{what}: {', '.join(names)}." for names, what in parts if names))
    return [camera for camera in made if camera is not None]


def cautions(desk: Desk) -> list[str]:
    """What one should have looked at before, camera by camera."""
    told = []
    for each in overview.overview(desk).cameras:
        for what, step in (("lens", each.lens), ("place", each.ground)):
            if step.verdict is overview.Verdict.DO_NOT_USE:
                told.append(f"The {what} of {each.name} should not be used: {step.words}")
    if ended := adjust_results.in_use(desk).ended:
        told.append(
            f"Lens or clicks of {', '.join(ended)} changed after adjusting: they stand by themselves, the "
            "others as they were adjusted. Adjust again."
        )
    return told


def compare(desk: Desk, user: User | None = None) -> Job:
    """Begin to compare the boxes of the dataset with those of the desk's cameras; nothing is changed yet.

    Raises DeskError.
    """
    if desk.dataset is None:
        raise DeskError("The desk has no dataset to compare with: import one with its cameras.")
    found = cameras(desk)
    if bent := [each.name for each in found if desk.dataset.undistorted and each.has_lens]:
        raise DeskError(
            f"The lens was taken out of this dataset's pictures, but {', '.join(bent)} would get one."
        )
    source = f"desk {desk.slug}"
    return calibration_job.start(desk.dataset, found, user, source, report=report(desk))


def report(desk: Desk) -> dict[str, Any]:
    """How the cameras came about: digests of what went in, settings, and figures per camera."""
    points = [[each.name, each.x, each.y, each.z] for each in desk.points.order_by("number")]
    last = desk.edits.filter(undone=False).order_by("-number").first()
    used = adjust_results.in_use(desk)
    return {
        "desk": desk.slug,
        "step": last.number if last else 0,
        "adjust": _of_result(desk, used) if used.number is not None else None,
        "points": {"count": len(points), "digest": _digest(points)},
        "cameras": [_of_camera(row) for row in desk.cameras.order_by("index")],
    }


def cameras_json(desk: Desk) -> bytes:
    """Raises DeskError."""
    return json.dumps(cameras_content(cameras(desk)), indent=2).encode() + b"\n"


def cameras_file(desk: Desk) -> Path:
    """The same as a file that an import can read; its name is its content's, so it never changes.

    Raises DeskError.
    """
    data = cameras_json(desk)
    path: Path = settings.UPLOADS_ROOT / f"desk-{hashlib.sha256(data).hexdigest()}.json"
    write_bytes(path, data)
    return path


def folder_zip(desk: Desk) -> bytes:
    """`calibrations/` as WILDTRACK lays it out, with what its numbers mean. Raises DeskError."""
    files = list(_files(desk))
    settings.UPLOADS_ROOT.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(prefix=".desk-", dir=settings.UPLOADS_ROOT) as name:
        path = Path(name) / "calibrations.zip"
        with stable_zip(path) as archive:
            for file, data in files:
                archive.add(file, data)
        return path.read_bytes()


def _files(desk: Desk) -> Iterator[tuple[str, bytes]]:
    found = cameras(desk)
    yield "calibrations/README.txt", README.format(slug=desk.slug).encode()
    bent = any(camera.has_lens for camera in found)
    yield from calibration_files(found, FootRule.CORNERS, "intrinsic_original" if bent else "intrinsic_zero")


def _of_result(desk: Desk, used: adjust_results.InUse) -> dict[str, Any]:
    """All that the adjustment told, with what it was asked and what it began from."""
    found = adjust_results.result_of(desk, used.number)
    told: dict[str, Any] = found.report or {}
    chosen = {name: value for name, value in found.choices.items() if name not in ("variant", "hold")}
    clicks, measured = found.inputs["clicks"], found.inputs["measured"]
    return {
        **told,
        "number": found.number,
        "settings": {**chosen, "hold": ", ".join(found.choices["hold"]) or None},
        "inputs": {
            "all": {"digest": found.of},
            "clicks": {"count": len(clicks), "digest": _digest(clicks)},
            "measured_points": {"count": len(measured), "digest": _digest(measured)},
        },
        "ended": used.ended,
    }


def _of_camera(row: DeskCamera) -> dict[str, Any]:
    clicks = [[each.point.name, each.x, each.y] for each in row.clicks.select_related("point")]
    used = [each for each in row.pose_report.get("residuals", []) if each["used"]]
    return {
        "name": row.name,
        "picture": row.full_digest,
        "lens": {
            "source": row.lens["source"] if row.lens else "",
            "board": (row.board or {}).get("board"),
            **{name: row.lens_report[name] for name in FIGURES if name in row.lens_report},
        },
        "ground": {
            "clicks": {"count": len(clicks), "digest": _digest(clicks)},
            "used": len(used),
            "rms": row.pose_report.get("rms"),
            "centre_sigma": row.pose_report.get("centre_sigma"),
            "findings": [each["text"] for each in row.pose_report.get("findings", [])],
        },
    }


def _digest(values: Any) -> str:
    return hashlib.sha256(json.dumps(values).encode()).hexdigest()
