from __future__ import annotations

import os
from typing import Any

from celery import Celery
from celery.schedules import crontab
from celery.signals import worker_init, worker_ready
from django.conf import settings
from kombu.transport import TRANSPORT_ALIASES

from annotator import clock
from annotator.private_files import keep_private

os.environ.setdefault("DJANGO_SETTINGS_MODULE", "annotator.settings")
TRANSPORT_ALIASES["filesystem"] = "annotator.folder_broker:Transport"

app = Celery("annotator")
worker_ready.connect(clock.watch)
app.set_default()  # "current" is per thread, and web servers have many
app.config_from_object("django.conf:settings", namespace="CELERY")
app.autodiscover_tasks()

# `expires`: while a worker is busy or away, at most one of each waits for it.
app.conf.beat_schedule = {
    "requeue-lost-jobs": {
        "task": "gtm_hit.tasks.requeue_lost_jobs",
        "schedule": 10.0,
        "options": {"expires": 9},
    },
    "expire-exports": {
        "task": "gtm_hit.tasks.expire_exports",
        "schedule": 3600.0,
        "options": {"expires": 3599},
    },
    "remove-unused-pictures": {
        "task": "gtm_hit.tasks.remove_unused_pictures",
        "schedule": 3600.0,
        "options": {"expires": 3599},
    },
    "resume-outboxes": {
        "task": "gtm_hit.tasks.resume_outboxes",
        "schedule": 60.0,
        "options": {"expires": 59},
    },
    "recompute-scores": {
        "task": "gtm_hit.tasks.recompute_scores",
        "schedule": crontab(hour=3, minute=20),
        "options": {"expires": 3600},
    },
    "expire-leases": {
        "task": "gtm_hit.tasks.expire_leases",
        "schedule": 60.0,
        "options": {"expires": 59},
    },
}


@worker_init.connect
def close_the_data_folder(**_given: Any) -> None:
    keep_private(settings.DATA_DIR)
