"""The product's settings, with a key and a data folder of the tests' own."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

os.environ.setdefault("SECRET_KEY", "tests-" + "k" * 40)
OWN = "gtm-tests-"
os.environ.setdefault("DATA_DIR", tempfile.mkdtemp(prefix=OWN))
_given = Path(os.environ["DATA_DIR"])
if _given.name.startswith(OWN) and (_worker := os.environ.get("PYTEST_XDIST_WORKER")):
    # Two at once would wait for each other's locks, and see each other's files.
    os.environ["DATA_DIR"] = str(_given / _worker)

from annotator.settings import *  # noqa: E402, F403

Path(FILE_UPLOAD_TEMP_DIR).mkdir(parents=True, exist_ok=True)  # noqa: F405
PASSWORD_HASHERS = ["django.contrib.auth.hashers.MD5PasswordHasher"]
# Names without hashes: no test has to collect the static files first.
STORAGES = {
    **STORAGES,  # noqa: F405
    "staticfiles": {"BACKEND": "django.contrib.staticfiles.storage.StaticFilesStorage"},
}
# A file, as in use: SQLite in shared memory refuses instead of waiting when several threads write.
DATABASES["default"]["TEST"] = {"NAME": str(DATA_DIR / "tests.sqlite3")}  # noqa: F405
# The live server of pytest-django serves static files only for the app under its plain name.
INSTALLED_APPS = [
    "django.contrib.staticfiles" if name == "annotator.apps.StaticFiles" else name
    for name in INSTALLED_APPS  # noqa: F405
]
# Tests that want a job start it.
PROPOSE_AUTOMATICALLY = False
