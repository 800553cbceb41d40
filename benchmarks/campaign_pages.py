"""What a large campaign does to its pages: `python -m benchmarks.campaign_pages [--json] [BATCHES WORKERS]`.

A database of its own in a temporary folder: 1,000 batches and 200 workers beside 10 and 2. Every page whose
address is named `campaign` or `campaign-…` and needs nothing but the campaign is asked for, and each
worker's page, the list of campaigns and the worker's own pages too. Prints queries and median milliseconds,
by the clock and of the processor; the limit is for the latter, which others at work do not stretch.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
from collections.abc import Iterator
from datetime import timedelta
from typing import Any

import django

from benchmarks.requests import Timed, timed

TIMES = 9
LIMIT_MS = 150
SIZE = 10
COPIES = 2


def prepare(folder: str) -> None:
    os.environ.update(DJANGO_SETTINGS_MODULE="annotator.settings", DATA_DIR=folder, DEBUG="0")
    os.environ.update(SECRET_KEY="k" * 50, DATABASE_URL=f"sqlite:///{folder}/b.sqlite3", LOG_LEVEL="ERROR")
    os.environ.update(ALLOWED_HOSTS="testserver", UNSAVED_PER_ADDRESS="1000000", UNSAVED_PER_LINK="1000000")
    django.setup()


def build(slug: str, batches: int, workers: int) -> Any:
    """Rows only: an open campaign of the own team in two copies; two thirds of its batches in every state
    there is, with people, decisions, remarks, scores and money."""
    from gtm_hit.models import Camera, Dataset, Frame
    from gtm_hit.ops.campaigns import editing, states

    dataset = Dataset.objects.create(slug=slug, name=slug)
    Camera.objects.create(
        dataset=dataset,
        index=0,
        name="C1",
        width=1920,
        height=1080,
        tvec=[0, 1, 12],
        rvec=[1.9, 0, 0],
        matrix=[[1000, 0, 960], [0, 1000, 540], [0, 0, 1]],
    )
    count = batches // COPIES * (SIZE - 1) + 1
    Frame.objects.bulk_create(Frame(dataset=dataset, number=5 * number) for number in range(count))
    values = {"name": "large", "platform": "own_team", "pay_per_batch": 2, "title": "A large one"}
    values |= {"copies": COPIES, "hourly_floor": 10}
    campaign = states.take(editing.create(dataset, values), "open")
    assert campaign.batches.count() == batches
    fill(campaign, people(campaign, workers))
    return campaign


def people(campaign: Any, count: int) -> list[Any]:
    from django.contrib.auth.models import User

    from gtm_hit.models import Worker
    from gtm_hit.ops.campaigns import accounts, links, standing

    slug = campaign.dataset.slug
    users = User.objects.bulk_create(User(username=f"{slug}-{n}", is_staff=True) for n in range(count))
    found = []
    for number, user in enumerate(users):
        worker = accounts.worker_of(user)
        found.append(worker)
        if number % 10 == 0:
            standing.put(campaign, worker, standing.Standing.INVITED, "", None)
        links.make(campaign, "personal", worker=worker)
    assert Worker.objects.filter(user__in=users).count() == count
    return found


def fill(campaign: Any, workers: list[Any]) -> None:
    """Assignments over a month, ten saved frames each, and what came after them."""
    from django.utils import timezone

    from benchmarks.campaign_history import history
    from gtm_hit.models import Assignment, Batch, Layer, LayerFrame

    now = timezone.now()
    campaign.opened_at = now - timedelta(days=30)
    campaign.save(update_fields=["opened_at"])
    chosen = list(campaign.batches.order_by("number", "copy"))
    chosen = chosen[: len(chosen) * 2 // 3]
    layers = Layer.objects.bulk_create(
        Layer(dataset=campaign.dataset, name=f"batch-{batch.number}-{batch.copy}", kind=Layer.Kind.ASSIGNMENT)
        for batch in chosen
    )
    states = ["accepted"] * 5 + ["submitted"] * 3 + ["returned", "leased", "rejected", "expired"]
    made = []
    for index, (batch, layer) in enumerate(zip(chosen, layers, strict=True)):
        state = states[index % len(states)]
        taken = now - timedelta(days=30 * (1 - index / len(chosen)))
        done = None if state in {"leased", "expired"} else taken + timedelta(minutes=20)
        ends = now + timedelta(hours=1) if state == "leased" else taken + timedelta(hours=2)
        made.append(
            Assignment(
                batch=batch,
                worker=workers[index % len(workers)],
                layer=layer,
                state=state,
                leased_at=taken,
                expires_at=ends,
                submitted_at=done,
            )
        )
    Assignment.objects.bulk_create(made)
    frames: dict[int, list[int]] = {}
    for batch_id, frame in Batch.frames.through.objects.filter(batch__in=chosen).values_list(
        "batch", "frame"
    ):
        frames.setdefault(batch_id, []).append(frame)
    LayerFrame.objects.bulk_create(
        (
            LayerFrame(layer=layer, frame_id=frame, revision=1, done=True, seconds=40 + batch.pk % 60)
            for batch, layer in zip(chosen, layers, strict=True)
            for frame in frames[batch.pk]
        ),
        batch_size=2000,
    )
    history(campaign, frames)


def addresses(campaign: Any) -> Iterator[tuple[str, str]]:
    """Name and path of every page there is, also of those other rooms add one day."""
    from django.urls import NoReverseMatch, get_resolver, reverse

    slug, name = campaign.dataset.slug, campaign.name
    worker = campaign.links.first().worker
    yield "campaigns", reverse("campaigns", args=[slug])
    for found in sorted({key for key in get_resolver().reverse_dict if isinstance(key, str)}):
        if found != "campaign" and not found.startswith("campaign-"):
            continue
        for given in ([slug, name], [slug, name, worker.pseudonym]):
            try:
                yield found, reverse(found, args=given)
            except NoReverseMatch:
                continue


def measure(campaign: Any) -> dict[str, Timed]:
    from django.contrib.auth.models import User
    from django.test import Client
    from django.urls import reverse

    from gtm_hit.ops.access import granting
    from gtm_hit.ops.access.roles import Role
    from gtm_hit.ops.work import links

    chief, _made = User.objects.get_or_create(username="chief", is_staff=True, is_superuser=True)
    client = Client()
    client.force_login(chief)
    found = {}
    for name, path in addresses(campaign):
        # Buttons are no pages.
        if client.get(path).status_code == 200:
            found[name] = timed(client, path, TIMES)
    worker = campaign.links.first().worker
    seat = links.seat_token(links.Seat(worker, campaign.dataset, campaign))
    found["work-home"] = timed(client, reverse("work-home", args=[seat]), TIMES)
    granting.grant(worker.user, Role.ANNOTATOR, campaign.dataset)
    client.force_login(worker.user)
    found["my-work"] = timed(client, reverse("my-work"), TIMES)
    return found


def main() -> int:
    words = [word for word in sys.argv[1:] if word != "--json"]
    batches, workers = (int(words[0]), int(words[1])) if len(words) == 2 else (1000, 200)
    with tempfile.TemporaryDirectory() as folder:
        prepare(folder)
        from django.core.management import call_command

        call_command("migrate", verbosity=0)
        call_command("collectstatic", interactive=False, verbosity=0)
        small = measure(build("small", 10, 2))
        large = measure(build("large", batches, workers))
    if "--json" in sys.argv:
        print(json.dumps({"small": small, "large": large, "limit_ms": LIMIT_MS}))
        return 0
    print(f"{'page':<28}{'queries':>8}{'ms':>8}{'busy':>8}   with 10 batches, 2 workers")
    for name, (queries, ms, busy) in large.items():
        few, quick, light = small.get(name, (0, 0.0, 0.0))
        told = "" if busy <= LIMIT_MS and queries <= few else "  <-"
        print(f"{name:<28}{queries:>8}{ms:>8.1f}{busy:>8.1f}   {few:>4}{quick:>8.1f}{light:>8.1f}{told}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
