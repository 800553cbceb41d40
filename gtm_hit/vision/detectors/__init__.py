"""Detectors: the built-in one, and those that somebody plugs in."""

from __future__ import annotations

from pathlib import Path

from gtm_hit.vision.detectors.errors import DetectorError
from gtm_hit.vision.detectors.http_plug import at_address
from gtm_hit.vision.detectors.nanodet import FILE_NAME, NanoDet
from gtm_hit.vision.detectors.python_plug import Params, from_entry_point, from_file, from_module, installed

__all__ = [
    "DetectorError",
    "NanoDet",
    "Params",
    "at_address",
    "built_in",
    "built_in_path",
    "from_entry_point",
    "from_file",
    "from_module",
    "installed",
]


def built_in_path(data_dir: Path) -> Path:
    """Where `make detector` puts the built-in detector's file."""
    return data_dir / "detector" / FILE_NAME


def built_in(data_dir: Path, path: Path | None = None) -> NanoDet | None:
    """The built-in detector, or None where its file was never made; DetectorError if it is damaged."""
    file = path or built_in_path(data_dir)
    return NanoDet.load(file) if path or file.is_file() else None
