"""Every step of the hand at a desk: written down when it is done, taken back and done again.

What can be changed by hand is a *thing*: of a kind, under a key, with a value that JSON holds or None where
it is not there. An edit changes several things together. Whatever follows from them (poses, for instance) is
no thing: it is computed anew after each edit, so it is right after undoing, too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from django.contrib.auth.models import User
from django.db import transaction
from django.db.models import Max

from gtm_hit.models import Desk, DeskEdit
from gtm_hit.ops.desk import poses
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.desk.things import THINGS

GROUND = "ground"
WORDS = 200

Wanted = tuple[str, list[str], Any]  # kind, key, the value it is to have


@dataclass(frozen=True)
class Steps:
    """What undo and redo would do on a page now, in words; empty where there is nothing."""

    undo: str
    redo: str


def lens_page(camera: str) -> str:
    return f"lens {camera}"


def edit(desk: Desk, page: str, what: str, wanted: Iterable[Wanted], author: User | None) -> DeskEdit | None:
    """Give things their values, in this order. None: everything was like that already.

    Raises DeskError, and nothing is changed.
    """
    with transaction.atomic():
        desk = _locked(desk)
        changes = []
        for kind, key, after in wanted:
            there = THINGS[kind].read(desk, key)
            if there != after:
                THINGS[kind].write(desk, key, after)
                changes.append([kind, key, there, after])
        if not changes:
            return None
        poses.follow(desk, changes)
        last = desk.edits.aggregate(last=Max("number"))["last"] or 0
        before = _to_undo(desk, page)
        follows = before.number if before else 0
        return DeskEdit.objects.create(
            desk=desk,
            number=last + 1,
            follows=follows,
            page=page,
            what=what[:WORDS],
            changes=changes,
            author=author,
        )


def undo(desk: Desk, page: str) -> DeskEdit | None:
    """Take the page's latest edit back; None where there is none."""
    return _step(desk, page, _to_undo, undone=True)


def redo(desk: Desk, page: str) -> DeskEdit | None:
    """Do again what was undone last, unless something newer was done since."""
    return _step(desk, page, _to_redo, undone=False)


def steps(desk: Desk, page: str) -> Steps:
    back, again = _to_undo(desk, page), _to_redo(desk, page)
    return Steps(back.what if back else "", again.what if again else "")


def _step(
    desk: Desk, page: str, chosen: Callable[[Desk, str], DeskEdit | None], *, undone: bool
) -> DeskEdit | None:
    with transaction.atomic():
        desk = _locked(desk)
        found = chosen(desk, page)
        if found is None:
            return None
        changes = [(kind, key, after, before) for kind, key, before, after in found.changes]
        if undone:
            changes.reverse()
        for kind, key, after, before in changes:
            expected, value = (after, before) if undone else (before, after)
            if THINGS[kind].read(desk, key) != expected:
                raise DeskError(f"{found.what}: this was changed elsewhere since. Load the page again.")
            THINGS[kind].write(desk, key, value)
        poses.follow(desk, found.changes)
        found.undone = undone
        found.save(update_fields=["undone"])
        return found


def _to_undo(desk: Desk, page: str) -> DeskEdit | None:
    return desk.edits.filter(page=page, undone=False).order_by("-number").first()


def _to_redo(desk: Desk, page: str) -> DeskEdit | None:
    """Of several that followed the same step, one after the other was undone, the newest."""
    last = _to_undo(desk, page)
    following = desk.edits.filter(page=page, undone=True, follows=last.number if last else 0)
    return following.order_by("-number").first()


def _locked(desk: Desk) -> Desk:
    return Desk.objects.select_for_update().get(pk=desk.pk)
