"""A worker that looks at a frame for as long as a test needs to kill it, and the dataset it looks at.

`celery -A tests.ops.proposals.slow_run worker` looks, `python -m tests.ops.proposals.slow_run` makes the
dataset and starts the job. Every look is a line in the file `looked` of the data folder.
"""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import Any

from celery.signals import worker_process_init

from annotator.celery import app

__all__ = ["app"]
SECONDS = 0.15  # a frame
FRAMES = 30


@worker_process_init.connect
def look_slowly(**_kwargs: Any) -> None:
    from gtm_hit.ops.proposals import looking

    looking.looker = slow_looker  # type: ignore[assignment]


def slow_looker(dataset: Any, *_order: str) -> Any:
    from django.conf import settings

    from tests.ops.proposals.watcher import Watcher, walk

    made = Watcher(dataset, walk(range(0, 5 * FRAMES, 5), (-4.0, 0.0), (0.25, 0.0)))

    def note(number: int) -> None:
        time.sleep(SECONDS)
        with (Path(settings.DATA_DIR) / "looked").open("a") as file:
            file.write(f"{number}\n")

    made.before = note
    return made


def start() -> None:
    from gtm_hit.models import Image
    from gtm_hit.ops.proposals import job
    from tests.ops.proposals.conftest import store
    from tests.work_scene import make_dataset

    dataset = make_dataset(frames=FRAMES, images=True)
    for image in Image.objects.filter(frame__dataset=dataset):
        store(image)
    print(job.start(dataset, job.Order()).pk)


if __name__ == "__main__":
    import django

    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "annotator.settings")
    django.setup()
    start()
