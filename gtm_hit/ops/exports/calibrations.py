"""The calibration of an export, in the files that readers of the two published data sets look for."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from gtm_hit.formats.calibration.wildtrack_xml import (
    Extrinsic,
    Intrinsic,
    Style,
    extrinsic_xml,
    intrinsic_xml,
)
from gtm_hit.geometry.camera import Camera
from gtm_hit.geometry.cylinder import FootRule

# Readers know WILDTRACK's cameras by these names, whatever the folders of their images are called.
WILDTRACK_NAMES = ("CVLab1", "CVLab2", "CVLab3", "CVLab4", "IDIAP1", "IDIAP2", "IDIAP3")
UNITS = {FootRule.CORNERS: "cm", FootRule.CENTRE: "m"}
STYLES = {FootRule.CORNERS: Style.TEXT, FootRule.CENTRE: Style.MATRIX}


def calibration_files(
    cameras: Sequence[Camera], rule: FootRule, folder: str | None = None
) -> Iterator[tuple[str, bytes]]:
    """Paths below the export and their bytes: an extrinsic and an intrinsic file for each camera.

    The foot rule tells which of the two data sets' readers the export is for: WILDTRACK's take `tvec` in
    centimetres as bare text, MultiviewX's in metres as matrices. `folder` is that of the intrinsic files;
    without it the lens decides.
    """
    if folder is None:
        folder = "intrinsic" if any(camera.has_lens for camera in cameras) else "intrinsic_zero"
    for name, camera in zip(published_names(cameras, rule), cameras, strict=True):
        pose = Extrinsic(camera.rvec, camera.tvec).in_unit(UNITS[rule])
        lens = Intrinsic(camera.matrix, camera.distortion, camera.model)
        yield f"calibrations/extrinsic/extr_{name}.xml", extrinsic_xml(pose, STYLES[rule])
        yield f"calibrations/{folder}/intr_{name}.xml", intrinsic_xml(lens)


def published_names(cameras: Sequence[Camera], rule: FootRule) -> list[str]:
    """The data sets call the cameras of the folders C1, C2 … differently in their calibrations."""
    names = [camera.name for camera in cameras]
    if names != [f"C{number}" for number in range(1, len(names) + 1)]:
        return names
    if rule == FootRule.CENTRE:
        return [f"Camera{number}" for number in range(1, len(names) + 1)]
    return list(WILDTRACK_NAMES) if len(names) == len(WILDTRACK_NAMES) else names
