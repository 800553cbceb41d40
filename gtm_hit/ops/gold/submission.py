"""What happens when work is handed in: faults are taken out, a try is judged, the score is computed later.

The score takes longer where there is gold, so it is left to a worker process: nobody learns from how long an
answer took.
"""

from __future__ import annotations

import logging
from functools import partial

from celery import current_app
from django.db import transaction

from gtm_hit.models import Assignment
from gtm_hit.ops.gold.withdraw import withdraw
from gtm_hit.ops.qualifications import judging

TASK = "gtm_hit.tasks.score_assignment"

logger = logging.getLogger(__name__)


def submitted(assignment: Assignment) -> None:
    """In the transaction that submits it."""
    withdraw(assignment)
    judging.judge(assignment)
    if assignment.batch.campaign_id is not None:
        transaction.on_commit(partial(send, assignment.pk))


def send(assignment_id: int) -> None:
    try:
        current_app.send_task(TASK, args=[assignment_id], retry=False, ignore_result=True)
    except Exception:
        # Every night all scores are computed anew.
        logger.exception("no broker to score assignment %s", assignment_id)
