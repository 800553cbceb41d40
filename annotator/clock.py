"""The clock inside `celery worker --beat` is a process, and Celery does not notice when it is killed."""

from __future__ import annotations

import logging
from typing import Any

from celery.bootsteps import RUN

SECONDS_BETWEEN_LOOKS = 5.0

logger = logging.getLogger(__name__)


def watch(sender: Any, **kwargs: Any) -> None:
    """Without a clock nobody looks for the jobs of killed workers."""
    sender.timer.call_repeatedly(SECONDS_BETWEEN_LOOKS, start_again_if_dead, (sender.controller,))


def start_again_if_dead(worker: Any) -> None:
    clock = next((step for step in worker.steps if step.label == "Beat"), None)
    if clock is None or clock.obj.is_alive() or worker.blueprint.state != RUN:
        return
    logger.warning("the clock was killed (%s); it is started again", clock.obj.exitcode)
    clock.obj = clock.create(worker)
    clock.obj.start()
