"""Every way an assignment goes from state to state: who may go it, what it needs, what it does besides."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from enum import StrEnum

from django.utils.translation import gettext as _

from gtm_hit.models import Assignment
from gtm_hit.ops.review import actors, deeds, needs
from gtm_hit.ops.review.actors import Actor
from gtm_hit.ops.review.asked import Asked
from gtm_hit.ops.review.refusals import WrongState

State = Assignment.State


class Action(StrEnum):
    SUBMIT = "submit"
    EXPIRE = "expire"
    GIVE_UP = "give_up"
    RENEW = "renew"
    ACCEPT = "accept"
    ACCEPT_UNSEEN = "accept_unseen"
    ACCEPT_MENDED = "accept_mended"
    RETURN = "return"
    TAKE_BACK = "take_back"
    REJECT = "reject"
    APPEAL = "appeal"
    UPHOLD = "uphold"
    OVERTURN = "overturn"


@dataclass(frozen=True)
class Step:
    """One line of the table."""

    begins: frozenset[str]
    ends: str
    who: Callable[[Assignment, Actor], None]
    needs: tuple[Callable[[Asked], None], ...] = ()
    does: tuple[Callable[[Asked], None], ...] = ()


def step(
    begins: Iterable[str],
    ends: str,
    who: Callable[[Assignment, Actor], None],
    *,
    needs: tuple[Callable[[Asked], None], ...] = (),
    does: tuple[Callable[[Asked], None], ...] = (),
) -> Step:
    return Step(frozenset(begins), ends, who, needs, does)


WORKER, REVIEWER, SYSTEM = actors.require_worker, actors.require_reviewer, actors.require_system

# fmt: off
TABLE: dict[Action, Step] = {
    Action.SUBMIT: step(
        [State.LEASED, State.RETURNED], State.SUBMITTED, WORKER,
        needs=(needs.time_left, needs.frames_done), does=(deeds.give_code,),
    ),
    Action.EXPIRE: step([State.LEASED], State.EXPIRED, SYSTEM, needs=(needs.time_over,)),
    Action.GIVE_UP: step(
        [State.LEASED, State.RETURNED], State.EXPIRED, SYSTEM,
        needs=(needs.reason,), does=(deeds.end_lease,),
    ),
    Action.RENEW: step([State.EXPIRED], State.LEASED, WORKER, needs=(needs.batch_free,)),
    Action.ACCEPT: step([State.SUBMITTED], State.ACCEPTED, REVIEWER),
    Action.ACCEPT_UNSEEN: step([State.SUBMITTED], State.ACCEPTED, SYSTEM, needs=(needs.not_chosen,)),
    Action.ACCEPT_MENDED: step(
        [State.SUBMITTED], State.ACCEPTED, REVIEWER, needs=(needs.own_mend,), does=(deeds.use_mend,),
    ),
    Action.RETURN: step([State.SUBMITTED], State.RETURNED, REVIEWER, needs=(needs.something_to_mend,)),
    Action.TAKE_BACK: step([State.RETURNED], State.EXPIRED, REVIEWER, needs=(needs.reason,)),
    Action.REJECT: step(
        [State.SUBMITTED], State.REJECTED, REVIEWER, needs=(needs.category, needs.long_reason),
    ),
    Action.APPEAL: step(
        [State.REJECTED], State.REJECTED, WORKER,
        needs=(needs.no_appeal_yet, needs.reason), does=(deeds.open_appeal,),
    ),
    Action.UPHOLD: step(
        [State.REJECTED], State.REJECTED, REVIEWER,
        needs=(needs.appeal_open, needs.somebody_else, needs.reason), does=(deeds.uphold,),
    ),
    Action.OVERTURN: step(
        [State.REJECTED], State.ACCEPTED, REVIEWER,
        needs=(needs.appeal_open, needs.somebody_else, needs.reason), does=(deeds.overturn,),
    ),
}
# fmt: on

DECISIONS = frozenset(
    {
        *(Action.ACCEPT, Action.ACCEPT_UNSEEN, Action.ACCEPT_MENDED, Action.RETURN, Action.TAKE_BACK),
        *(Action.REJECT, Action.UPHOLD, Action.OVERTURN),
    }
)


def required(action: Action, asked: Asked) -> Step:
    """The step, if this actor may take it now; otherwise it raises what is in the way."""
    found = TABLE[action]
    found.who(asked.assignment, asked.by)
    if asked.assignment.state not in found.begins:
        state = asked.assignment.get_state_display()
        raise WrongState(_("This batch is %(state)s: that is not possible any more.") % {"state": state})
    for need in found.needs:
        need(asked)
    return found
