"""A campaign with bonuses to send, in a site of its own: `-m tests.ops.outbox.paid_scene build|start`."""

from __future__ import annotations

import os
import sys


def build() -> None:
    from gtm_hit.models import Assignment, Campaign
    from gtm_hit.ops.outbox import planning
    from gtm_hit.ops.pay import table
    from tests.paid_campaign import assign, make_account, make_campaign
    from tests.prolific_server import TOKEN
    from tests.work_scene import make_worker

    campaign = make_campaign(platform=Campaign.Platform.PROLIFIC)
    make_account(campaign, token=TOKEN)
    state = Assignment.State.ACCEPTED
    for number in (1, 2, 3):
        assign(campaign, make_worker(f"p{number}", "prolific"), state, minutes=30, submission=f"s{number}")
    table.approve_bonuses(campaign, None)
    planning.plan_payouts(campaign, None)


def start() -> None:
    from gtm_hit.models import Campaign
    from gtm_hit.ops.outbox import sending

    print(sending.start(Campaign.objects.get()).pk)


if __name__ == "__main__":
    import django

    os.environ.setdefault("DJANGO_SETTINGS_MODULE", "annotator.settings")
    django.setup()
    {"build": build, "start": start}[sys.argv[1]]()
