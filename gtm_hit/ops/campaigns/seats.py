"""Where a worker is known, and who may end what leads to their work there."""

from __future__ import annotations

from django.contrib.auth.models import User
from django.db.models import Q, QuerySet
from django.utils.translation import gettext as _

from gtm_hit.models import Campaign, Dataset, Worker
from gtm_hit.ops.access.roles import Role, datasets_of
from gtm_hit.ops.campaigns.errors import CampaignError
from gtm_hit.ops.work import links


def known(campaign: Campaign) -> QuerySet[Worker]:
    """Whoever took a batch of the campaign, was invited or blocked, has a link or tried to qualify."""
    return Worker.objects.filter(
        Q(pk__in=campaign.batches.values("assignments__worker"))
        | Q(pk__in=campaign.workers.values("worker"))
        | Q(pk__in=campaign.links.values("worker"))
        | Q(pk__in=campaign.required_qualifications.values("qualification__attempts__worker")),
        platform=campaign.platform,
    )


def named(campaign: Campaign, name: str) -> Worker | None:
    """One of them by pseudonym, or by the platform's own id."""
    found = known(campaign)
    return found.filter(pseudonym=name).first() or found.filter(external_id=name).first()


def revoke(worker: Worker, user: User) -> None:
    """Ends everything that leads to their work, wherever that is: all of it must be the manager's.

    One secret of the worker's is in all of their addresses, so that there is no ending some of them.
    """
    mine = datasets_of(user, Role.MANAGER)
    if datasets(worker).exclude(pk__in=mine.values("pk")).exists():
        text = _(
            "This worker has work or links in datasets that you do not manage, and all links end together. "
            "Revoke the links of the batches one by one, or ask somebody who manages all of them."
        )
        raise CampaignError(text, "deed")
    links.revoke_worker(worker)


def datasets(worker: Worker) -> QuerySet[Dataset]:
    return Dataset.objects.filter(
        Q(pk__in=worker.assignments.values("batch__dataset"))
        | Q(pk__in=worker.links.values("campaign__dataset"))
        | Q(pk__in=worker.campaigns.values("campaign__dataset"))
    )
