from __future__ import annotations

import json
import subprocess
import sys
import time
import zipfile
from pathlib import Path
from typing import Any

from django.contrib.auth.models import User

from gtm_hit.models import Job
from gtm_hit.ops import api_tokens
from gtm_hit.ops.jobs import queue
from gtm_hit.tasks import OPERATIONS
from tests.dataset_folder import VALUES, make_folder

CLIENT = Path(__file__).resolve().parents[2] / "docs" / "example_client.py"


def test_the_documented_client_goes_from_images_to_a_release(
    live_server: Any, settings: Any, tmp_path: Path
) -> None:
    for name in ("TABLES", "EXPORTS", "RELEASES", "UPLOADS", "INCOMING", "MEDIA"):
        setattr(settings, f"{name}_ROOT", tmp_path / name.lower())
    make_folder(tmp_path / "incoming" / "square")
    user = User.objects.create_user("script", is_superuser=True)
    _token, key = api_tokens.make(user, "all", ["read", "import", "work", "release"])
    wanted = [live_server.url, key, "incoming/square", "square", "truth", json.dumps({"values": VALUES})]

    client = subprocess.Popen(
        [sys.executable, CLIENT, *wanted],
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    while client.poll() is None:  # a Celery worker's part
        for job in Job.objects.filter(state=Job.State.QUEUED):
            queue.run(job.pk, OPERATIONS)
        time.sleep(0.1)
    said = client.communicate()[0]

    assert client.returncode == 0, said
    assert "1 batches" in said
    with zipfile.ZipFile(tmp_path / "square-1.zip") as release:
        assert "square-release-1/people.csv" in release.namelist()
