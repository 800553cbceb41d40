"""Archives that came through a browser, with everything somebody may have put into them."""

from __future__ import annotations

import os
import struct
import time
import zipfile
from contextlib import suppress
from datetime import timedelta
from pathlib import Path

import pytest
from django.core.files.uploadedfile import SimpleUploadedFile
from hypothesis import given
from hypothesis import strategies as st

from gtm_hit.formats.problems import FormatError
from gtm_hit.models import Job
from gtm_hit.ops.files import sources
from tests.archives import link, made, zipped


@pytest.fixture(autouse=True)
def own_folders(settings: object, tmp_path: Path) -> None:
    settings.INCOMING_ROOT = tmp_path / "incoming"  # type: ignore[attr-defined]
    settings.UPLOADS_ROOT = tmp_path / "uploads"  # type: ignore[attr-defined]
    settings.MAX_UPLOAD_MB = 5  # type: ignore[attr-defined]


def refused(archive: Path) -> str:
    with pytest.raises(FormatError) as caught:
        sources.checked_entries(archive)
    return str(caught.value)


def no_progress(_done: int, _total: int) -> None:
    pass


# What may be in an archive


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("../evil.txt", "leads out of the archive"),
        ("a/../../evil.txt", "leads out of the archive"),
        ("/etc/evil.txt", "an absolute path"),
        ("C:/evil.txt", "an absolute path"),
        ("a\\..\\evil.txt", "a backslash"),
    ],
)
def test_paths_that_lead_elsewhere_are_refused(tmp_path: Path, name: str, reason: str) -> None:
    told = refused(made(tmp_path / "a.zip", (name, b"x"), ("fine.txt", b"x")))
    assert reason in told and "fine.txt" not in told


def test_links_are_refused(tmp_path: Path) -> None:
    assert "neither a file nor a folder" in refused(made(tmp_path / "a.zip", link("images", "/etc")))


def test_bombs_are_refused(tmp_path: Path) -> None:
    told = refused(made(tmp_path / "a.zip", ("zeros.bin", bytes(4_000_000))))
    assert "zeros.bin: shrunk to less than a 100th" in told


def test_too_much_in_all_is_refused(tmp_path: Path) -> None:
    entries = [(f"{number}.bin", os.urandom(10_000) * 90) for number in range(25)]
    assert "unpacks to more than 20 MB" in refused(made(tmp_path / "a.zip", *entries))


def test_too_many_entries_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sources, "MOST_ENTRIES", 2)
    told = refused(made(tmp_path / "a.zip", *[(f"{number}.txt", b"x") for number in range(3)]))
    assert "holds 3 entries; at most 2" in told


def test_encrypted_entries_are_refused(tmp_path: Path) -> None:
    archive = made(tmp_path / "a.zip", ("secret.txt", b"x"))
    data = bytearray(archive.read_bytes())
    data[data.index(b"PK\x01\x02") + 8] |= 1
    archive.write_bytes(data)
    assert "secret.txt: encrypted" in refused(archive)


@pytest.mark.filterwarnings("ignore:Duplicate name")
@pytest.mark.parametrize(
    "names", [("a.txt", "a.txt"), ("A.txt", "a.txt"), ("a", "a/b.txt"), ("a/b.txt", "a")]
)
def test_names_that_clash_are_refused(tmp_path: Path, names: tuple[str, str]) -> None:
    told = refused(made(tmp_path / "a.zip", *[(name, b"x") for name in names]))
    assert "there twice" in told or "lies in what is a file" in told


def test_what_is_no_archive_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.zip").write_bytes(b"GIF89a")
    assert "no zip archive" in refused(tmp_path / "a.zip")
    assert "holds no files" in refused(made(tmp_path / "b.zip"))


def test_all_that_is_wrong_is_told_at_once(tmp_path: Path) -> None:
    told = refused(made(tmp_path / "a.zip", ("../x", b"x"), link("y", "/"), ("/z", b"z")))
    assert len(told.splitlines()) == 3


@given(data=st.binary(max_size=300), cut=st.integers(0, 300))
def test_any_bytes_are_refused_or_read(
    tmp_path_factory: pytest.TempPathFactory, data: bytes, cut: int
) -> None:
    folder = tmp_path_factory.mktemp("any")
    archive = made(folder / "a.zip", ("a.txt", b"some text " * 20))
    whole = archive.read_bytes()
    archive.write_bytes(whole[:cut] + data + whole[cut + len(data) :])
    with suppress(FormatError):
        sources.unpack(archive, folder / "out", no_progress)
    assert {path.name for path in folder.iterdir()} <= {"a.zip", "out"}


# Unpacking


def test_every_file_comes_out_as_it_went_in(tmp_path: Path) -> None:
    source = tmp_path / "source"
    (source / "deep" / "er").mkdir(parents=True)
    (source / "deep" / "er" / "a.bin").write_bytes(os.urandom(3_000_000))
    (source / "b.txt").write_text("b")
    sources.unpack(zipped(source, tmp_path / "a.zip"), tmp_path / "out", no_progress)
    found = {path.relative_to(tmp_path / "out"): path for path in (tmp_path / "out").rglob("*.*")}
    assert {str(name) for name in found} == {"deep/er/a.bin", "b.txt"}
    assert all(path.read_bytes() == (source / name).read_bytes() for name, path in found.items())


def test_what_operating_systems_add_stays_behind(tmp_path: Path) -> None:
    names = ["a.txt", "__MACOSX/._a.txt", "deep/.DS_Store", "Thumbs.db"]
    archive = made(tmp_path / "a.zip", *[(name, b"x") for name in names])
    sources.unpack(archive, tmp_path / "out", no_progress)
    assert [path.name for path in (tmp_path / "out").rglob("*")] == ["a.txt"]


def test_a_directory_that_lies_about_a_size_gains_nothing(tmp_path: Path) -> None:
    archive = made(tmp_path / "a.zip", ("a.bin", bytes(900_000) + os.urandom(100_000)))
    data = bytearray(archive.read_bytes())
    at = data.index(b"PK\x01\x02") + 24
    data[at : at + 4] = struct.pack("<I", 10)
    archive.write_bytes(data)
    with pytest.raises(FormatError):
        sources.unpack(archive, tmp_path / "out", no_progress)
    assert sum(path.stat().st_size for path in (tmp_path / "out").rglob("*.bin")) <= 10


def test_damaged_contents_are_refused_by_name(tmp_path: Path) -> None:
    archive = made(tmp_path / "a.zip", ("fine.txt", b"fine"), ("hurt.bin", os.urandom(5000)))
    data = bytearray(archive.read_bytes())
    data[2500] ^= 0xFF
    archive.write_bytes(data)
    with pytest.raises(FormatError, match=r"hurt\.bin: cannot be unpacked"):
        sources.unpack(archive, tmp_path / "out", no_progress)


def test_the_dataset_may_lie_in_folders_of_the_archive(tmp_path: Path) -> None:
    inner = tmp_path / "out" / "Dataset v1" / "data"
    (inner / "Image_subsets").mkdir(parents=True)
    (inner / "calibrations").mkdir()
    assert sources.dataset_folder(tmp_path / "out") == inner


def test_a_folder_of_images_alone_in_an_archive_is_not_taken_for_the_dataset(tmp_path: Path) -> None:
    outer = tmp_path / "out" / "plaza"
    (outer / "Image_subsets" / "C1").mkdir(parents=True)
    assert sources.dataset_folder(tmp_path / "out") == outer


# Sources


def test_an_upload_becomes_a_source_under_a_safe_name(tmp_path: Path) -> None:
    data = made(tmp_path / "a.zip", ("a.txt", b"x")).read_bytes()
    kept = sources.keep(SimpleUploadedFile("..\\we ird/näme.zip", data))
    assert kept.path.parent == tmp_path / "uploads" and kept.path.read_bytes() == data
    assert [each.key for each in sources.sources()] == [kept.key]


def test_a_refused_upload_is_not_kept(tmp_path: Path) -> None:
    with pytest.raises(FormatError) as caught:
        sources.keep(SimpleUploadedFile("a.zip", b"no archive"))
    assert list((tmp_path / "uploads").iterdir()) == []
    assert str(tmp_path) not in str(caught.value)


def test_folders_and_archives_put_on_the_server_are_sources(tmp_path: Path) -> None:
    (tmp_path / "incoming" / "plaza").mkdir(parents=True)
    (tmp_path / "incoming" / ".hidden").mkdir()
    made(tmp_path / "incoming" / "b.zip", ("a.txt", b"x"))
    (tmp_path / "incoming" / "notes.txt").touch()
    assert [each.key for each in sources.sources()] == ["incoming/b.zip", "incoming/plaza"]


@pytest.mark.parametrize("key", ["incoming/../secret", "incoming/link", "/etc", "", "incoming/", "secret"])
def test_no_key_names_a_path_outside(tmp_path: Path, key: str) -> None:
    (tmp_path / "secret").mkdir()
    (tmp_path / "incoming").mkdir()
    (tmp_path / "incoming" / "link").symlink_to(tmp_path / "secret")
    assert sources.source(key) is None


@pytest.mark.django_db
def test_old_uploads_and_dead_unpacking_are_removed(tmp_path: Path) -> None:
    alive = Job.objects.create(kind=Job.Kind.IMPORT_DATASET, state=Job.State.DONE, attempts=1)
    root = tmp_path / "uploads"
    root.mkdir()
    old, new = made(root / "old.zip", ("a", b"x")), made(root / "new.zip", ("a", b"x"))
    days = sources.KEPT + timedelta(hours=1)
    os.utime(old, (0, time.time() - days.total_seconds()))
    (root / f"unpacked-{alive.pk}-1").mkdir()
    sources.remove_leftovers()
    assert list(root.iterdir()) == [new]


@pytest.mark.django_db
def test_what_a_running_job_unpacks_stays(tmp_path: Path) -> None:
    job = Job.objects.create(kind=Job.Kind.IMPORT_DATASET, state=Job.State.RUNNING, attempts=2)
    root = tmp_path / "uploads"
    for attempt in (1, 2):
        (root / f"unpacked-{job.pk}-{attempt}").mkdir(parents=True)
    sources.remove_leftovers()
    assert [path.name for path in root.iterdir()] == [f"unpacked-{job.pk}-2"]


def test_sizes_are_told_as_the_bytes_arrive(tmp_path: Path) -> None:
    archive = tmp_path / "a.zip"
    with zipfile.ZipFile(archive, "w") as out:
        out.writestr("a.bin", os.urandom(3_500_000))
    told: list[tuple[int, int]] = []
    sources.unpack(archive, tmp_path / "out", lambda done, total: told.append((done, total)))
    assert told[-1] == (3, 3) and told == sorted(told)
