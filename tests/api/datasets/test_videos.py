from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from gtm_hit.models import Frame, Job
from gtm_hit.ops.jobs import queue
from gtm_hit.tasks import OPERATIONS
from tests.api.conftest import bearer
from tests.dataset_folder import NAMES, VALUES
from tests.video_files import make_videos


@pytest.mark.django_db
def test_videos_become_frames_by_nothing_but_requests(settings: Any, tmp_path: Path) -> None:
    for name in ("DATA", "TABLES", "UPLOADS", "INCOMING"):
        setattr(settings, f"{name}_{'DIR' if name == 'DATA' else 'ROOT'}", tmp_path / name.lower())
    settings.MEDIA_ROOT = tmp_path / "media"
    make_videos(settings.INCOMING_ROOT / "street", 60, 30.0)
    script = bearer("read", "import")
    given = {name: value for name, value in VALUES.items() if not name.startswith(("annotation_", "frame_"))}
    wanted = {
        "source": "incoming/street",
        "slug": "street",
        "values": given,
        "videos": [
            {"camera": name, "file": f"{name}.mp4", "offset": offset}
            for name, offset in zip(NAMES, (0.0, 0.1, 0.5), strict=True)
        ],
        "until": 1.0,
    }
    response = script.post("/api/v1/video-imports/", wanted)
    assert response.status_code == 202, response.json()
    queue.run(response.json()["id"], OPERATIONS)
    job = script.get(f"/api/v1/jobs/{response.json()['id']}/").json()
    assert (job["state"], job["result"]["frames"]) == ("done", 3), job["message"]
    # Ten numbers a second, every fifth of them: WILDTRACK's, for nothing else was said.
    assert sorted(Frame.objects.values_list("number", flat=True)) == [0, 5, 10]
    assert Job.objects.get().dataset.slug == "street"  # type: ignore[union-attr]
