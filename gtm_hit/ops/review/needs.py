"""What steps of the machine need besides the right state and the right person."""

from __future__ import annotations

from django.contrib.auth.models import User
from django.utils import timezone
from django.utils.translation import gettext as _

from gtm_hit.models import Appeal, Assignment, Campaign, Category, Comment, Mend, ReviewChoice, Transition
from gtm_hit.ops.review.asked import Asked
from gtm_hit.ops.review.refusals import Incomplete, OwnWork, WrongState
from gtm_hit.ops.work.readiness import ReadOnly, Unfinished, read_only_reason, unfinished_frames

MOST_LETTERS = 4000
FEW_LETTERS = 20  # of a rejection: nobody is sent away with a word
PLATFORM_LETTERS = 100  # what Prolific asks of a rejection


def time_left(asked: Asked) -> None:
    if found := read_only_reason(asked.assignment):
        raise ReadOnly(found)


def frames_done(asked: Asked) -> None:
    if missing := unfinished_frames(asked.assignment):
        raise Unfinished(missing)


def time_over(asked: Asked) -> None:
    if asked.assignment.expires_at > timezone.now():
        raise WrongState(_("The lease has not run out yet."))


def batch_free(asked: Asked) -> None:
    if batch_taken(asked.assignment):
        raise WrongState(_("Somebody else has the batch now."))


def batch_taken(assignment: Assignment) -> bool:
    others = Assignment.objects.filter(batch=assignment.batch_id, state__in=Assignment.HOLDING)
    return others.exclude(pk=assignment.pk).exists()


def not_chosen(asked: Asked) -> None:
    if not ReviewChoice.objects.filter(assignment=asked.assignment, chosen=False).exists():
        raise WrongState(_("A person has to review this batch."))


def own_mend(asked: Asked) -> None:
    """Whoever put the copy right vouches for it."""
    mine = Mend.objects.filter(assignment=asked.assignment, accepted_at=None)
    if not isinstance(asked.by, User) or not mine.filter(user=asked.by).exists():
        raise Incomplete(_("You have no corrected copy of this batch."))


def something_to_mend(asked: Asked) -> None:
    """Whoever gets work back is told what to do, in a comment or in the reason."""
    told = Comment.objects.filter(assignment=asked.assignment, user__isnull=False, resolved_at=None)
    if not asked.reason and not told.exists():
        raise Incomplete(_("Say what has to be put right: in a comment, or as a reason."))
    not_too_long(asked)


def category(asked: Asked) -> None:
    if asked.category not in Category.values:
        raise Incomplete(
            _("A rejection needs one of these categories: %(all)s.") % {"all": ", ".join(Category)}
        )


def reason(asked: Asked) -> None:
    if not asked.reason:
        raise Incomplete(_("Say why."))
    not_too_long(asked)


def long_reason(asked: Asked) -> None:
    reason(asked)
    least = least_letters(asked.assignment)
    if len(asked.reason) < least:
        text = _("Explain the rejection in %(least)d characters or more: the worker is to learn from it.")
        raise Incomplete(text % {"least": least})


def least_letters(assignment: Assignment) -> int:
    """Of the reason of a rejection."""
    campaign = assignment.batch.campaign
    prolific = campaign is not None and campaign.platform == Campaign.Platform.PROLIFIC
    return PLATFORM_LETTERS if prolific else FEW_LETTERS


def not_too_long(asked: Asked) -> None:
    if len(asked.reason) > MOST_LETTERS:
        raise Incomplete(_("A reason has at most %(most)d characters.") % {"most": MOST_LETTERS})


def no_appeal_yet(asked: Asked) -> None:
    if Appeal.objects.filter(assignment=asked.assignment).exists():
        raise WrongState(_("There was an appeal already; one may appeal once."))


def appeal_open(asked: Asked) -> None:
    if not Appeal.objects.filter(assignment=asked.assignment, outcome=Appeal.Outcome.OPEN).exists():
        raise WrongState(_("There is no open appeal."))


def somebody_else(asked: Asked) -> None:
    """Not whoever rejected the work."""
    rejected = (
        Transition.objects.filter(assignment=asked.assignment, action="reject").order_by("number").last()
    )
    if isinstance(asked.by, User) and rejected and rejected.user_id == asked.by.pk:
        raise OwnWork(_("You rejected this batch: somebody else decides the appeal."))
