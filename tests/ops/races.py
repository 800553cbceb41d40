"""Many processes doing the same thing at once; run as a program on the database of DATABASE_URL.

Prints one JSON object: by race, what every process got.
"""

from __future__ import annotations

import json
import multiprocessing
import sys
import uuid
from collections.abc import Callable
from typing import Any

import django

PROCESSES = 50
Contest = list[Callable[[], Any]]


def main() -> None:
    django.setup()
    from django.core.management import call_command

    call_command("migrate", verbosity=0)
    races = {race.__name__: run(race()) for race in RACES}
    json.dump(races, sys.stdout)


def run(contest: Contest) -> list[Any]:
    """What each competitor returned, or the name of its error; all start at the same moment."""
    from django.db import connections

    # A connection that two processes share is broken for both.
    connections.close_all()
    context = multiprocessing.get_context("fork")
    barrier, results = context.Barrier(len(contest)), context.SimpleQueue()
    processes = [context.Process(target=compete, args=(one, barrier, results)) for one in contest]
    for process in processes:
        process.start()
    answers = [results.get() for _process in processes]
    for process in processes:
        process.join()
    return answers


def compete(competitor: Callable[[], Any], barrier: Any, results: Any) -> None:
    barrier.wait()
    try:
        results.put(competitor())
    except Exception as error:
        results.put(type(error).__name__)


def claiming() -> Contest:
    """50 workers, 40 batches."""
    from gtm_hit.ops.work import assignments, batches
    from tests.work_scene import make_dataset, make_worker

    dataset = make_dataset("claiming", frames=80)
    batches.make_batches(dataset, size=2)
    workers = [make_worker(f"claiming {index}") for index in range(PROCESSES)]
    return [lambda worker=worker: assignments.claim(worker, dataset).batch_id for worker in workers]


def claiming_copies() -> Contest:
    """50 workers, 20 batches three times."""
    from gtm_hit.ops.work import assignments, batches
    from tests.work_scene import make_dataset, make_worker

    dataset = make_dataset("copies", frames=20)
    batches.make_batches(dataset, size=1, copies=3)
    workers = [make_worker(f"copies {index}") for index in range(PROCESSES)]
    return [lambda worker=worker: assignments.claim(worker, dataset).batch_id for worker in workers]


def one_worker() -> Contest:
    """One worker pressing the button in 20 tabs."""
    from gtm_hit.ops.work import assignments, batches
    from tests.work_scene import make_dataset, make_worker

    dataset = make_dataset("tabs", frames=60)
    batches.make_batches(dataset, size=2)
    worker = make_worker("tabs")
    return [lambda: assignments.claim(worker, dataset).pk] * 20


def one_worker_of_two() -> Contest:
    """One worker asking for one more in 20 tabs, where the campaign lets him hold two."""
    from gtm_hit.ops.work import assignments
    from gtm_hit.ops.work.pools import Pool
    from tests.campaign_scene import make_campaign
    from tests.work_scene import make_dataset, make_worker

    campaign = make_campaign(make_dataset("two tabs", frames=60), batches_at_once=2)
    worker, pool = make_worker("two tabs"), Pool(campaign.dataset, campaign)
    return [lambda: assignments.claim(worker, pool, another=True).pk] * 20


def expired_batch() -> Contest:
    """A worker comes back after the end of his lease while 19 others ask for the only batch."""
    from django.utils import timezone

    from gtm_hit.models import Assignment
    from gtm_hit.ops.work import assignments, batches
    from tests.work_scene import make_dataset, make_worker

    dataset = make_dataset("expired", frames=2)
    batches.make_batches(dataset)
    workers = [make_worker(f"expired {index}") for index in range(20)]
    old = assignments.claim(workers[0], dataset)
    Assignment.objects.filter(pk=old.pk).update(expires_at=timezone.now())
    return [lambda worker=worker: assignments.claim(worker, dataset).batch_id for worker in workers]


def arriving() -> Contest:
    """One id arriving 20 times."""
    from gtm_hit.ops.work import workers

    return [lambda: workers.enter("panel", "The Same").pk] * 20


def making_batches() -> Contest:
    """Ten people pressing the button."""
    from gtm_hit.ops.work import batches
    from tests.work_scene import make_dataset

    dataset = make_dataset("making", frames=95)
    return [lambda: batches.make_batches(dataset, copies=2)] * 10


def repeated_save() -> Contest:
    """One save sent 20 times."""
    from tests.work_scene import make_dataset, make_layer, row, save

    dataset = make_dataset("repeated", frames=1)
    layer, frame, save_id = make_layer(dataset), dataset.frames.get(), uuid.uuid4()
    return [lambda: save(layer, frame, [row()], save_id=save_id).revision] * 20


def competing_saves() -> Contest:
    """Twenty saves that started from the same revision."""
    from tests.work_scene import make_dataset, make_layer, row, save

    dataset = make_dataset("competing", frames=1)
    layer, frame = make_layer(dataset), dataset.frames.get()
    return [lambda person=person: save(layer, frame, [row(person)]).revision for person in range(1, 21)]


def shared_save_id() -> Contest:
    """One save id for ten frames."""
    from tests.work_scene import make_dataset, make_layer, row, save

    dataset = make_dataset("shared", frames=10)
    layer, save_id = make_layer(dataset), uuid.uuid4()
    return [
        lambda frame=frame: save(layer, frame, [row()], save_id=save_id).number
        for frame in dataset.frames.all()
    ]


def submitting() -> Contest:
    """One finished batch submitted ten times."""
    from gtm_hit.ops.work import assignments, batches
    from tests.work_scene import do_frames, make_dataset, make_worker

    dataset = make_dataset("submitting", frames=2)
    batches.make_batches(dataset)
    assignment = assignments.claim(make_worker("submitting"), dataset)
    do_frames(assignment)
    return [lambda: assignments.submit(assignment).code] * 10


def saving_and_submitting() -> Contest:
    """Saves racing with the submission: each is either in before it or refused."""
    from gtm_hit.ops.work import assignments, batches
    from tests.work_scene import do_frames, make_dataset, make_worker, row, save

    dataset = make_dataset("saving", frames=10)
    batches.make_batches(dataset)
    assignment = assignments.claim(make_worker("saving"), dataset)
    do_frames(assignment)
    layer, worker = assignment.layer, assignment.worker
    saves: Contest = [
        lambda frame=frame: save(layer, frame, [row()], 1, author=worker, done=True).revision
        for frame in dataset.frames.all()
    ]
    return [*saves, lambda: assignments.submit(assignment).state]


def deciding() -> Contest:
    """Ten reviewers, half of whom accept what the others reject."""
    from gtm_hit.ops.review.machine import Action
    from gtm_hit.ops.review.transitions import transition
    from tests.ops.review.scene import REASON, make_reviewer, make_work, submitted

    work = submitted("deciding", make_work(2, 2, slug="deciding"))
    reviewers = [make_reviewer(f"deciding-{index}") for index in range(10)]
    how = {"category": "low_effort", "reason": REASON}
    actions = [Action.ACCEPT, Action.REJECT] * 5
    return [
        lambda by=by, action=action: transition(work, action, by, **how).state
        for by, action in zip(reviewers, actions, strict=True)
    ]


def overturning() -> Contest:
    """A rejection is overturned while ten others ask for the batch that it freed."""
    from gtm_hit.ops.review.machine import Action
    from gtm_hit.ops.review.transitions import transition
    from gtm_hit.ops.work import assignments
    from tests.ops.review.scene import REASON, make_reviewer, make_work, submitted
    from tests.work_scene import make_worker

    dataset = make_work(2, 2, slug="overturning")
    work = submitted("overturning", dataset)
    how = {"category": "low_effort", "reason": REASON}
    transition(work, Action.REJECT, make_reviewer("overturning-1"), **how)
    transition(work, Action.APPEAL, work.worker, reason="Look again")
    workers = [make_worker(f"overturning {index}") for index in range(10)]
    other = make_reviewer("overturning-2")
    claims: Contest = [lambda one=one: assignments.claim(one, dataset).batch_id for one in workers]
    return [*claims, lambda: transition(work, Action.OVERTURN, other, reason="Right").state]


def looking_back() -> Contest:
    """No race: what the history says, which each database counts in its own way."""
    from gtm_hit.ops.frames.saving import history, state_at
    from tests.work_scene import make_dataset, make_layer, row, save

    dataset = make_dataset("history", frames=1)
    layer, frame = make_layer(dataset), dataset.frames.get()
    save(layer, frame, [row(1), row(2)])
    save(layer, frame, [], 1)
    return [
        lambda: [revision.people for revision in history(layer, frame)],
        lambda: [list(row.as_dict()) for row in state_at(layer, frame, 1).annotations],
    ]


RACES = [
    deciding,
    overturning,
    looking_back,
    claiming,
    claiming_copies,
    one_worker,
    one_worker_of_two,
    expired_batch,
    arriving,
    making_batches,
    repeated_save,
    competing_saves,
    shared_save_id,
    submitting,
    saving_and_submitting,
]

if __name__ == "__main__":
    main()
