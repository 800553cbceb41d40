"""The own team: accounts with a login, the workers they are, and invitations that make them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from django.contrib.auth.models import User
from django.contrib.auth.password_validation import validate_password
from django.core.exceptions import ValidationError
from django.db import IntegrityError, transaction
from django.db.models import Count, Exists, OuterRef, Q, QuerySet, Sum
from django.utils.translation import gettext as _

from gtm_hit.models import Assignment, Campaign, CampaignLink, CampaignWorker, Comment, Worker
from gtm_hit.ops.access.granting import grant
from gtm_hit.ops.access.roles import Role, may
from gtm_hit.ops.campaigns import account, standing
from gtm_hit.ops.campaigns.errors import CampaignError
from gtm_hit.ops.counting import correlated_count
from gtm_hit.ops.pay.sums import Balance
from gtm_hit.ops.work import links

PLATFORM = Campaign.Platform.OWN_TEAM


def worker_of(user: User) -> Worker:
    """The worker this account is; made when it is needed for the first time."""
    found = Worker.objects.filter(user=user).first()
    if found:
        return found
    # An account of the same name that is gone was somebody else: its work stays its own.
    taken = Worker.objects.filter(platform=PLATFORM, external_id=user.username).exists()
    external_id = f"{user.username}#{user.pk}" if taken else user.username
    worker, _made = Worker.objects.get_or_create(
        user=user, defaults={"platform": PLATFORM, "external_id": external_id}
    )
    return worker


def accept(link: CampaignLink, username: str, password: str) -> User:
    """Make the account an invitation is for. It works once. Raises CampaignError naming the field."""
    username = username.strip()
    user = User(username=username)
    try:
        user.full_clean(exclude=["password"])
        validate_password(password, user)
    except ValidationError as error:
        raise refusal_of(error) from error
    try:
        with transaction.atomic():
            locked = CampaignLink.objects.select_for_update(no_key=True).get(pk=link.pk)
            require_open(locked)
            user.set_password(password)
            user.save()
            take_in(locked, user)
    except IntegrityError:
        raise CampaignError(_("Somebody has this name already; choose another."), "username") from None
    return user


def join(link: CampaignLink, user: User) -> None:
    """Whoever has an account already accepts an invitation with it. Raises CampaignError."""
    with transaction.atomic():
        locked = CampaignLink.objects.select_for_update(no_key=True).get(pk=link.pk)
        require_open(locked)
        take_in(locked, user)


def require_open(link: CampaignLink) -> None:
    if link.state != "open":
        raise CampaignError(_("This invitation was used already, or it is over."))


def take_in(link: CampaignLink, user: User) -> None:
    worker = worker_of(user)
    grant(user, Role.ANNOTATOR, link.campaign.dataset)
    row = CampaignWorker.objects.filter(campaign=link.campaign, worker=worker).first()
    # A block is the manager's decision, and no link undoes it.
    if row is None:
        standing.put(link.campaign, worker, standing.Standing.INVITED, "", link.created_by)
    link.worker, link.uses = worker, 1
    link.save(update_fields=["worker", "uses"])


def refusal_of(error: ValidationError) -> CampaignError:
    if hasattr(error, "error_dict"):
        field, problems = next(iter(error.message_dict.items()))
        return CampaignError(" ".join(problems), field)
    return CampaignError(" ".join(error.messages), "password")


@dataclass(frozen=True)
class Place:
    """A campaign as somebody of the own team sees it on their page."""

    campaign: Campaign
    link: str  # to their seat there; empty until it was opened for the first time
    held: int
    submitted: int
    score: str  # in words; empty before there is enough
    balance: Balance | None


def places(user: User) -> list[Place]:
    """Open campaigns the account may work in, and those it has worked in; a constant number of queries."""
    worker = Worker.objects.filter(user=user).first()
    mine = Assignment.objects.filter(worker=worker, batch__campaign=OuterRef("pk")) if worker else None
    rows = Campaign.objects.filter(platform=PLATFORM).select_related("dataset")
    blocked, invited = standings(worker, "blocked"), standings(worker, "invited")
    offered = Q(state=Campaign.State.OPEN) & ~Q(pk__in=blocked)
    offered &= Q(entry=Campaign.Entry.ANYONE) | Q(entry=Campaign.Entry.QUALIFIED) | Q(pk__in=invited)
    worked = Q(Exists(mine)) if mine is not None else Q(pk__in=[])
    held = Q(batches__assignments__worker=worker, batches__assignments__state__in=["leased", "returned"])
    done = Q(batches__assignments__worker=worker, batches__assignments__submitted_at__isnull=False)
    counted = rows.filter(offered | worked).annotate(
        held=Count("batches__assignments", filter=held), done=Count("batches__assignments", filter=done)
    )
    chosen = [
        row for row in counted.order_by("dataset__slug", "name") if may(user, Role.ANNOTATOR, row.dataset)
    ]
    told = account.of_several(worker, chosen) if worker else {}
    return [place(row, worker, *told.get(row.pk, ("", None))) for row in chosen]


def place(row: Any, worker: Worker | None, score: str, balance: Balance | None) -> Place:
    link = links.seat_token(links.Seat(worker, row.dataset, row)) if worker else ""
    return Place(row, link, row.held, row.done, score, balance)


def standings(worker: Worker | None, standing: str) -> QuerySet[CampaignWorker, int]:
    rows = CampaignWorker.objects.filter(worker=worker, standing=standing)
    return rows.values_list("campaign", flat=True)


def batches(user: User) -> QuerySet[Assignment]:
    """What the account ever took, the newest first, with `frames_done`, `seconds` and `open_comments`."""
    remarks = Comment.objects.filter(assignment=OuterRef("pk"), answers=None, resolved_at=None)
    done = Count("layer__layer_frames", filter=Q(layer__layer_frames__done=True))
    return (
        Assignment.objects.filter(worker__user=user)
        .select_related("batch__dataset", "batch__campaign", "worker")
        .annotate(frames_done=done, seconds=Sum("layer__layer_frames__seconds"))
        .annotate(open_comments=correlated_count(remarks, "assignment", "pk"))
        .order_by("-leased_at")
    )
