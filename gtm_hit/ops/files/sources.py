"""Archives of datasets: what may be in them, how they are unpacked, and where imports find them.

`incoming/` belongs to whoever runs the server: folders, archives and videos are put there by hand and stay.
`uploads/` belongs to the pages: an archive is removed once it is imported, or a week later.
"""

from __future__ import annotations

import logging
import os
import re
import shutil
import stat
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from datetime import timedelta
from pathlib import Path, PurePosixPath
from tempfile import TemporaryDirectory
from uuid import uuid4

from django.conf import settings
from django.core.files.uploadedfile import TemporaryUploadedFile, UploadedFile
from django.utils import timezone

from gtm_hit.formats.dataset_folder import natural_key
from gtm_hit.formats.files import replacing
from gtm_hit.formats.layout import IMAGE_FOLDERS
from gtm_hit.formats.problems import FormatError, Problem, ProblemList
from gtm_hit.models import Job
from gtm_hit.ops.access.roles import Role, Somebody, may_everywhere
from gtm_hit.ops.jobs.progress import Steps

MEGABYTE = 1_000_000
MOST_ENTRIES = 500_000
MOST_UNPACKED = 4  # times the largest archive; images do not shrink
MOST_RATIO = 100  # an entry to its compressed bytes
FREE_RATIO_BYTES = 1_000_000  # entries up to here may shrink as they like: an empty JSON list does
BLOCK = 1 << 20
VIDEO_SUFFIXES = {".mp4", ".m4v", ".mov", ".mkv", ".avi", ".mts", ".ts", ".mpg", ".mpeg", ".webm", ".wmv"}
KEPT = timedelta(days=7)
REGULAR = {0, stat.S_IFREG, stat.S_IFDIR}  # 0: made where files have no kind

logger = logging.getLogger(__name__)
_UNSAFE = re.compile(r"[^A-Za-z0-9._-]+")
_UNPACKED = re.compile(r"unpacked-(?P<job>\d+)-(?P<attempt>\d+)")
_DRIVE = re.compile(r"[A-Za-z]:")


@dataclass(frozen=True)
class Source:
    """A folder or archive an import can be started with; `key` is its name in forms and jobs."""

    key: str
    path: Path

    @property
    def is_archive(self) -> bool:
        return self.path.is_file()

    @property
    def was_uploaded(self) -> bool:
        return self.key.startswith("uploads/")


def sources() -> list[Source]:
    """Everything there is to choose from; nothing whose links lead out of its folder."""
    roots = {"incoming": settings.INCOMING_ROOT, "uploads": settings.UPLOADS_ROOT}
    found = []
    for kind, root in roots.items():
        entries = sorted(root.iterdir(), key=lambda path: natural_key(path.name)) if root.is_dir() else []
        for path in entries:
            inside = path.resolve().is_relative_to(root.resolve())
            folder = kind == "incoming" and path.is_dir()
            archive = path.suffix.lower() == ".zip" and path.is_file()
            if path.name[0] != "." and inside and (folder or archive):
                found.append(Source(f"{kind}/{path.name}", path))
    return found


def offered(user: Somebody) -> list[Source]:
    """Those somebody may choose from a list: whoever has to do with one dataset only sends his own."""
    return sources() if may_everywhere(user, Role.MAINTAINER) else []


def source_of(key: str, user: Somebody) -> Source | None:
    """The source of this name, if somebody may use it: an upload's name is known to who sent it."""
    found = source(key)
    return found if found and (found.was_uploaded or may_everywhere(user, Role.MAINTAINER)) else None


def source(key: str) -> Source | None:
    """Only what is listed: no key can name a path of its own."""
    return next((each for each in sources() if each.key == key), None)


def holds(source: Source, path: Path) -> bool:
    """Whether a path seen from the source's folder is a file in there, links followed."""
    found = (source.path / path).resolve()
    return found.is_relative_to(source.path.resolve()) and found.is_file()


def videos(source: Source) -> list[Path]:
    """Video files in the source's folder, as they are named there."""
    found = [path.name for path in source.path.iterdir() if path.suffix.lower() in VIDEO_SUFFIXES]
    return [Path(name) for name in sorted(found, key=natural_key) if holds(source, Path(name))]


def most_bytes() -> int:
    return settings.MAX_UPLOAD_MB * MEGABYTE


def keep(upload: UploadedFile) -> Source:
    """Put an uploaded archive among the sources.

    Raises FormatError with all reasons when it cannot be a dataset's; it is not kept then.
    """
    stem = _UNSAFE.sub("-", Path(upload.name or "").stem).strip(".-")[:60] or "dataset"
    path = settings.UPLOADS_ROOT / f"{stem}-{uuid4().hex[:8]}.zip"
    try:
        _take(upload, path)
        checked_entries(path)
    except FormatError as error:
        path.unlink(missing_ok=True)
        raise error.relative_to(settings.UPLOADS_ROOT) from error
    return Source(f"uploads/{path.name}", path)


def _take(upload: UploadedFile, path: Path) -> None:
    """Large uploads lie on the disk already, and only get a second name."""
    if isinstance(upload, TemporaryUploadedFile):
        path.parent.mkdir(parents=True, exist_ok=True)
        with suppress(OSError):  # on another disk
            upload.flush()
            os.link(upload.temporary_file_path(), path)
            return
    with replacing(path) as stream:
        for chunk in upload.chunks():
            stream.write(chunk)


def checked_entries(path: Path) -> list[zipfile.ZipInfo]:
    """The files of an archive by its directory. Raises FormatError with everything that is not right."""
    problems = ProblemList(path)
    try:
        with zipfile.ZipFile(path) as archive:
            infos = archive.infolist()
    except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError) as error:
        problems.add("", f"no zip archive that can be read: {error}")
        raise FormatError(problems.found) from error
    if path.stat().st_size > most_bytes():
        problems.add("", f"larger than {settings.MAX_UPLOAD_MB} MB")
    if len(infos) > MOST_ENTRIES:
        problems.add("", f"holds {len(infos)} entries; at most {MOST_ENTRIES} are accepted")
        problems.raise_if_any()
    if sum(info.file_size for info in infos) > MOST_UNPACKED * most_bytes():
        problems.add("", f"unpacks to more than {MOST_UNPACKED * settings.MAX_UPLOAD_MB} MB")
    seen: dict[str, str] = {}
    for info in infos:
        reason = _reason_against(info) or _clash(info, seen)
        if reason:
            problems.add(info.filename, reason)
    problems.raise_if_any()
    files = [info for info in infos if not info.is_dir() and not _is_litter(info.filename)]
    if not files:
        problems.add("", "holds no files")
    problems.raise_if_any()
    return files


def unpack(path: Path, folder: Path, progress: Steps) -> None:
    """Write the archive's files below `folder`; counts bytes itself, for a directory may lie about sizes."""
    files = checked_entries(path)
    total = sum(info.file_size for info in files)
    left = MOST_UNPACKED * most_bytes()
    done = 0
    with zipfile.ZipFile(path) as archive:
        for info in files:
            target = folder / info.filename
            for block in _blocks(archive, info, target, path):
                done += block
                if done > left:
                    raise FormatError(_one(path, "", "unpacks to more than its directory says"))
                progress(done // MEGABYTE, max(total, done) // MEGABYTE)


def dataset_folder(folder: Path) -> Path:
    """Where the dataset begins: archives often hold one folder that holds everything.

    A folder of images that is alone, as beside a calibration that comes from a desk, is not that one.
    """
    while True:
        entries = [path for path in folder.iterdir() if path.name[0] != "."]
        if len(entries) != 1 or not entries[0].is_dir() or entries[0].is_symlink():
            return folder
        if entries[0].name in IMAGE_FOLDERS:
            return folder
        folder = entries[0]


@contextmanager
def unpacked(source: Source, job: Job, progress: Steps) -> Iterator[Path]:
    """The source as a folder, which is gone afterwards if it came out of an archive."""
    if not source.is_archive:
        yield source.path
        return
    folder = settings.UPLOADS_ROOT / f"unpacked-{job.pk}-{job.attempts}"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    try:
        unpack(source.path, folder, progress)
        yield dataset_folder(folder)
    finally:
        shutil.rmtree(folder, ignore_errors=True)


@contextmanager
def extracted(path: Path, progress: Steps) -> Iterator[Path]:
    """A folder as it is, or what is in a zip, which is gone afterwards; checked as an upload is."""
    if path.is_dir() or path.suffix.lower() != ".zip":
        yield path
        return
    settings.UPLOADS_ROOT.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(prefix=".extracted-", dir=settings.UPLOADS_ROOT) as name:
        folder = Path(name)
        unpack(path, folder, progress)
        yield dataset_folder(folder)


def let_go(key: str, job: Job) -> None:
    """Remove an uploaded archive its job has imported, unless another job was started with it as well."""
    found = source(key)
    if found is None or not found.was_uploaded or key in _wanted(but=job):
        return
    try:
        found.path.unlink(missing_ok=True)
    except OSError:
        # The import is done all the same; the clock tries again in a week.
        logger.exception("%s cannot be removed", found.path)


def remove_leftovers() -> None:
    """What killed workers and commands unpacked, archives nobody imported for a week, and halves of them."""
    _remove_halves()
    if not settings.UPLOADS_ROOT.is_dir():
        return
    running = set(Job.objects.filter(state=Job.State.RUNNING).values_list("pk", "attempts"))
    wanted = _wanted()
    oldest = (timezone.now() - KEPT).timestamp()
    for path in settings.UPLOADS_ROOT.iterdir():
        match = _UNPACKED.fullmatch(path.name)
        old = path.stat().st_mtime < oldest
        if match:
            abandoned = (int(match["job"]), int(match["attempt"])) not in running
        else:
            abandoned = path.is_dir() and path.name[0] == "." and old
        if abandoned:
            shutil.rmtree(path, ignore_errors=True)
        elif path.is_file() and old and not running and f"uploads/{path.name}" not in wanted:
            path.unlink(missing_ok=True)


def _wanted(but: Job | None = None) -> set[str]:
    """Sources of jobs that are under way or wait for a worker."""
    jobs = Job.objects.filter(state__in=[Job.State.QUEUED, Job.State.RUNNING])
    if but is not None:
        jobs = jobs.exclude(pk=but.pk)
    return {key for key in jobs.values_list("parameters__source", flat=True) if key}


def _remove_halves() -> None:
    """What servers that were killed had received so far."""
    oldest = (timezone.now() - KEPT).timestamp()
    for path in Path(settings.FILE_UPLOAD_TEMP_DIR).glob("*"):
        if path.is_file() and path.stat().st_mtime < oldest:
            path.unlink(missing_ok=True)


def _reason_against(info: zipfile.ZipInfo) -> str:
    name = info.filename
    parts = PurePosixPath(name).parts
    if "\\" in info.orig_filename or "\x00" in info.orig_filename:
        return "a name with a backslash or a zero byte"
    if not parts or name.startswith("/") or _DRIVE.match(name):
        return "an absolute path, or none"
    if ".." in parts:
        return "leads out of the archive"
    if stat.S_IFMT(info.external_attr >> 16) not in REGULAR:
        return "neither a file nor a folder"
    if info.flag_bits & 0x1:
        return "encrypted"
    if info.file_size > FREE_RATIO_BYTES and info.file_size > MOST_RATIO * max(info.compress_size, 1):
        return f"shrunk to less than a {MOST_RATIO}th: no picture does"
    return ""


def _clash(info: zipfile.ZipInfo, seen: dict[str, str]) -> str:
    """A name there before, be it in other capitals, or a file taken for a folder."""
    path = PurePosixPath(info.filename)
    key = str(path).casefold()
    kind = "folder" if info.is_dir() else "file"
    if (kind == "file" and key in seen) or seen.get(key, kind) != kind:
        return "there twice"
    seen[key] = kind
    for parent in path.parents:
        if seen.setdefault(str(parent).casefold(), "folder") != "folder":
            return "lies in what is a file"
    return ""


def _is_litter(name: str) -> bool:
    """What operating systems add to archives by themselves."""
    parts = PurePosixPath(name).parts
    return "__MACOSX" in parts or parts[-1] in {".DS_Store", "Thumbs.db", "desktop.ini"}


def _blocks(archive: zipfile.ZipFile, info: zipfile.ZipInfo, target: Path, path: Path) -> Iterator[int]:
    """Write one file; yields the size of every block before it is written."""
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with archive.open(info) as packed, target.open("xb") as stream:
            while block := packed.read(BLOCK):
                yield len(block)
                stream.write(block)
    except (zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError, RuntimeError, OSError) as error:
        reason = getattr(error, "strerror", None) or str(error) or type(error).__name__
        raise FormatError(_one(path, info.filename, f"cannot be unpacked: {reason}")) from error


def _one(path: Path, place: str, reason: str) -> list[Problem]:
    problems = ProblemList(path)
    problems.add(place, reason)
    return problems.found
