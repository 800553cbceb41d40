"""Pictures that two imports share, and those that nobody uses."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress
from datetime import timedelta
from pathlib import Path
from threading import Event, Thread
from typing import Any

import pytest
from django.core.files.storage import default_storage
from django.core.management import call_command
from django.db import connections
from django.utils import timezone

from gtm_hit.models import Dataset, Image
from gtm_hit.ops.datasets.importing import ImportFailed, import_dataset
from gtm_hit.ops.files.images import storage_name, store
from gtm_hit.ops.files.picture_cleanup import pictures_in_use, remove_unused_pictures
from tests.dataset_folder import make_folder, options

pytestmark = pytest.mark.django_db

TOMORROW = timezone.now() + timedelta(days=2)  # of the collecting, however long the tests before take


@pytest.fixture(autouse=True)
def own_folders(settings: Any, tmp_path: Path) -> None:
    settings.DATA_DIR = tmp_path / "data"
    settings.MEDIA_ROOT = tmp_path / "media"
    settings.TABLES_ROOT = tmp_path / "tables"
    settings.EXPORTS_ROOT = tmp_path / "exports"
    settings.UPLOADS_ROOT = tmp_path / "uploads"


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    return make_folder(tmp_path / "square")


def missing() -> list[str]:
    """Of the pictures that images name, those that are not there."""
    names = [storage_name(digest) for pair in pairs() for digest in pair]
    return [name for name in names if not default_storage.exists(name)]


def pairs() -> list[tuple[str, str]]:
    return list(Image.objects.values_list("light_digest", "full_digest"))


def at(moment: str, act: Callable[[], object]) -> Callable[[str, int, int], None]:
    def progress(phase: str, done: int, total: int, /) -> None:
        if (phase, done) == (moment, total):
            act()

    return progress


def test_an_import_that_is_cancelled_takes_no_picture_from_another(folder: Path) -> None:
    made, cancelled = Event(), Event()

    def cancel() -> None:
        made.set()
        cancelled.wait()
        raise KeyboardInterrupt

    def first() -> None:
        with suppress(KeyboardInterrupt):
            import_dataset(options(folder, slug="one"), at("making images", cancel))
        connections.close_all()

    def cancel_the_first() -> None:
        cancelled.set()
        thread.join()

    thread = Thread(target=first)
    thread.start()
    made.wait()
    import_dataset(options(folder, slug="two"), at("making images", cancel_the_first))
    assert Dataset.objects.get().slug == "two" and len(pairs()) == 6
    assert missing() == []


def test_a_second_import_of_the_same_folder_makes_missing_pictures_again(folder: Path) -> None:
    import_dataset(options(folder))
    for light, _full in pairs()[:2]:
        default_storage.delete(storage_name(light))
    assert len(missing()) == 2
    report = import_dataset(options(folder))
    assert (missing(), report.images_added, report.frames_added) == ([], 0, 0)


def test_a_picture_made_again_by_another_encoder_is_found_under_its_new_name(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    import_dataset(options(folder))
    gone = pairs()[0][0]
    default_storage.delete(storage_name(gone))
    monkeypatch.setattr("gtm_hit.ops.files.images.LIGHT_QUALITY", 70)
    import_dataset(options(folder))
    assert missing() == [] and gone not in {light for light, _full in pairs()}


def test_pictures_nobody_uses_go_after_a_day_and_the_others_stay(folder: Path) -> None:
    import_dataset(options(folder))
    unused = storage_name(store(b"of an import that failed"))
    assert remove_unused_pictures(timezone.now() + timedelta(hours=23)) == 0
    assert remove_unused_pictures(TOMORROW) == 1
    assert not default_storage.exists(unused) and missing() == []


def test_what_a_killed_import_had_half_written_goes_too(tmp_path: Path) -> None:
    half = tmp_path / "media" / "images" / "ab" / f".{'ab' * 32}.jpg.x1.tmp"
    half.parent.mkdir(parents=True)
    half.write_bytes(b"\xff\xd8")
    assert remove_unused_pictures(TOMORROW) == 1 and not half.exists()


def test_nothing_is_removed_while_an_import_is_under_way(tmp_path: Path) -> None:
    store(b"found there by an import that is long")
    with pictures_in_use():
        assert remove_unused_pictures(TOMORROW) == 0
    assert remove_unused_pictures(TOMORROW) == 1


def test_a_killed_import_does_not_keep_them_for_ever(tmp_path: Path, settings: Any) -> None:
    store(b"of a killed import")
    code = """if True:
        import django, time
        django.setup()
        from gtm_hit.ops.files.picture_cleanup import pictures_in_use
        with pictures_in_use():
            print("holds", flush=True)
            time.sleep(60)
    """
    names = {"DJANGO_SETTINGS_MODULE": "tests.settings", "DATA_DIR": str(settings.DATA_DIR)}
    environment = {**os.environ, **names}
    process = subprocess.Popen([sys.executable, "-c", code], env=environment, stdout=subprocess.PIPE)
    assert process.stdout is not None and process.stdout.readline() == b"holds\n"
    assert remove_unused_pictures(TOMORROW) == 0
    process.kill()
    process.wait(timeout=30)
    assert remove_unused_pictures(TOMORROW) == 1


def test_the_command_removes_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name = storage_name(store(b"of an import that failed"))
    old = time.time() - 2 * 86_400
    os.utime(default_storage.path(name), (old, old))
    call_command("cleanup")
    assert "1 unused pictures removed." in capsys.readouterr().out
    assert not default_storage.exists(name)


def test_a_refused_import_leaves_pictures_only_until_tomorrow(folder: Path, tmp_path: Path) -> None:
    broken = folder / "Image_subsets" / "C3" / "00000005.png"
    broken.write_bytes(broken.read_bytes()[:-50])
    with pytest.raises(ImportFailed):
        import_dataset(options(folder))
    remove_unused_pictures(TOMORROW)
    assert not list((tmp_path / "media").rglob("*.jpg"))
