"""A job that says nothing for as long as one likes, and a worker whose patience is a quarter of the usual.

`celery -A tests.ops.jobs.long_job worker` does it,
`python -m tests.ops.jobs.long_job computing|writing SECONDS` starts it.
"""

from __future__ import annotations

import hashlib
import os
import sys
import time
from datetime import timedelta
from pathlib import Path
from typing import Any

from celery.signals import worker_process_init

from annotator.celery import app

app.conf.beat_schedule["requeue-lost-jobs"] |= {"schedule": 2.0, "options": {"expires": 2}}
KIND = "export_layer"


def silent(mine: Any) -> dict[str, Any]:
    from django.conf import settings
    from django.db import transaction

    from gtm_hit.models import Dataset

    seconds = mine.job.parameters["seconds"]
    if mine.job.parameters["how"] == "writing":
        with transaction.atomic():
            Dataset.objects.create(slug="silent", name="Silent")
            time.sleep(seconds)
    else:
        until, block = time.monotonic() + seconds, bytes(1 << 16)
        while time.monotonic() < until:
            hashlib.sha256(block)
    with mine.holding(1, 1), (Path(settings.DATA_DIR) / "done").open("a") as file:
        file.write(f"{mine.attempt}\n")
    return {"attempt": mine.attempt}


@worker_process_init.connect
def hurry(**_kwargs: Any) -> None:
    from gtm_hit import tasks
    from gtm_hit.ops.jobs import lease, queue

    tasks.OPERATIONS[KIND] = silent
    queue.LOST_AFTER, queue.STOPPED_AFTER = timedelta(seconds=5), timedelta(seconds=10)
    lease.SECONDS_BETWEEN_BEATS = 1.0


def start(how: str, seconds: str) -> None:
    from gtm_hit.ops.jobs import queue

    print(queue.create(KIND, None, {"how": how, "seconds": float(seconds)}).pk)


if __name__ == "__main__":
    import django

    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "annotator.settings")
    django.setup()
    start(*sys.argv[1:])
