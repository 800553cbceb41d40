"""The pages about pay and the platform with 1,000 batches of 200 workers, who are all owed something.

`python -m benchmarks.campaign_pay` prints milliseconds (median of seven) and queries of each page.
"""

from __future__ import annotations

import os
import tempfile
from decimal import Decimal
from pathlib import Path

from benchmarks.requests import timed

WORKERS, EACH, FRAMES = 200, 5, 10


def build() -> None:
    from django.utils import timezone

    from gtm_hit.models import Assignment, Batch, Campaign, Dataset, Frame, Layer, LayerFrame, Worker
    from gtm_hit.ops.outbox import planning
    from gtm_hit.ops.pay import table

    dataset = Dataset.objects.create(slug="square", name="Square")
    pay = {"pay_per_batch": Decimal("2.25"), "hourly_floor": Decimal(12), "currency": "EUR"}
    campaign = Campaign.objects.create(dataset=dataset, name="autumn", platform="prolific", **pay)
    count, now = WORKERS * EACH, timezone.now()
    workers = Worker.objects.bulk_create(
        Worker(platform="prolific", external_id=f"p{number}") for number in range(WORKERS)
    )
    frames = Frame.objects.bulk_create(
        Frame(dataset=dataset, number=number) for number in range(count * FRAMES)
    )
    batches = Batch.objects.bulk_create(
        Batch(dataset=dataset, campaign=campaign, number=number + 1) for number in range(count)
    )
    layers = Layer.objects.bulk_create(
        Layer(dataset=dataset, name=f"batch-{number:04d}", kind=Layer.Kind.ASSIGNMENT)
        for number in range(count)
    )
    Assignment.objects.bulk_create(
        Assignment(
            batch=batches[number],
            layer=layers[number],
            worker=workers[number % WORKERS],
            state=Assignment.State.ACCEPTED,
            submission=f"s{number}",
            expires_at=now,
            submitted_at=now,
        )
        for number in range(count)
    )
    LayerFrame.objects.bulk_create(
        LayerFrame(
            layer=layers[number // FRAMES], frame=frame, revision=1, done=True, seconds=70 + number % 60
        )
        for number, frame in enumerate(frames)
    )
    table.approve_bonuses(campaign, None)
    planning.plan_payouts(campaign, None)


def measure() -> None:
    from django.contrib.auth.models import User
    from django.test import Client

    from gtm_hit.ops.access import granting
    from gtm_hit.ops.access.roles import Role

    client = Client()
    vera = User.objects.create_user("vera")
    granting.grant(vera, Role.MANAGER)
    client.force_login(vera)
    for page in ("pay/", "pay/workers.csv", "platform/"):
        count, middle, busy = timed(client, f"/datasets/square/campaigns/autumn/{page}", 7)
        print(f"{page:<16} {middle:6.0f} ms, {busy:4.0f} ms of the processor, {count} queries")


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        os.environ |= {
            "SECRET_KEY": "b" * 40,
            "DATA_DIR": folder,
            "DEBUG": "false",
            "ALLOWED_HOSTS": "testserver",
            "LOG_LEVEL": "ERROR",
        }
        os.environ["DATABASE_URL"] = os.environ.get("BENCHMARK_DATABASE_URL", f"sqlite:///{folder}/b.sqlite3")
        os.environ["DJANGO_SETTINGS_MODULE"] = "tests.settings"
        import django
        from django.core.management import call_command

        (Path(folder) / "static").mkdir()
        django.setup()
        call_command("migrate", verbosity=0)
        build()
        measure()


if __name__ == "__main__":
    main()
