"""Drafts of clocks: opened for a folder, changed state by state, undone and redone."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import cv2
from django.contrib.auth.models import User
from django.db import transaction
from django.utils.translation import gettext as _

from gtm_hit.models import VideoSync, VideoSyncState
from gtm_hit.ops.datasets.videos.video import FASTEST, VideoError, VideoReader, opened
from gtm_hit.ops.files import sources
from gtm_hit.ops.sync.guessing import SyncRefused
from gtm_hit.ops.sync.state import Clock, State, camera_name, check, state_of


class StaleDraft(SyncRefused):
    """Somebody else, or another window, has changed it meanwhile; `draft` is what it is now."""

    def __init__(self, draft: VideoSync) -> None:
        super().__init__(_("This was changed in another window meanwhile; here is what it is now."))
        self.draft = draft


def open_draft(source: sources.Source, user: User | None = None) -> VideoSync:
    """The folder's draft, made if there is none; videos that came or went since are taken over."""
    if source.is_archive:
        raise SyncRefused(_("Videos lie in a folder, not in an archive."))
    facts = [_facts(source, path) for path in sources.videos(source)]
    if len(facts) < 2:
        raise SyncRefused(_("There are fewer than two videos in this folder."))
    files = [each["file"] for each in facts]
    with transaction.atomic():
        draft = VideoSync.objects.select_for_update().filter(source=source.key).first()
        if draft is None:
            draft = VideoSync.objects.create(source=source.key, facts=facts, created_by=user, position=0)
            _add(draft, State(tuple(_first_clock(file) for file in files)))
        elif draft.facts != facts:
            state = _with_files(current(draft), files)
            if [clock.file for clock in state.clocks] != [each["file"] for each in draft.facts]:
                # What was before is of other videos: nothing could be undone to.
                draft.states.all().delete()
                draft.position = 0
            draft.facts = facts
            _add(draft, state)
    return draft


def current(draft: VideoSync) -> State:
    return state_of(draft.states.get(number=draft.position).content)


def save(pk: int, revision: int, state: State) -> VideoSync:
    """Raises SyncRefused for what cannot be, and StaleDraft; nothing is changed then."""
    with _changing(pk, revision) as draft:
        files = [each["file"] for each in draft.facts]
        check(state, files)
        clocks = sorted(state.clocks, key=lambda each: files.index(each.file))
        _add(draft, replace(state, clocks=tuple(clocks)))
    return draft


def take_guess(pk: int, revision: int) -> VideoSync:
    """Put what was guessed in place; a video that was not found keeps the clock it has."""
    with _changing(pk, revision) as draft:
        places = draft.guess.get("places", [])
        found = {each["file"]: each["offset"] for each in places if each["offset"] is not None}
        state = current(draft)
        clocks = tuple(
            replace(clock, offset=found[clock.file], drift=0.0) if clock.file in found else clock
            for clock in state.clocks
        )
        if not found or not found.keys() <= {clock.file for clock in clocks}:
            raise SyncRefused(_("There is no guess of these videos yet."))
        _add(draft, replace(state, clocks=clocks, reference=min(found, key=lambda file: found[file])))
    return draft


@dataclass(frozen=True)
class Steps:
    """What can be taken back, and done again."""

    undo: bool
    redo: bool


def steps(draft: VideoSync) -> Steps:
    return Steps(draft.position > 1, draft.states.filter(number=draft.position + 1).exists())


def undo(pk: int, revision: int) -> VideoSync:
    return _move(pk, revision, -1)


def redo(pk: int, revision: int) -> VideoSync:
    return _move(pk, revision, 1)


def _move(pk: int, revision: int, step: int) -> VideoSync:
    """At either end it stays where it is."""
    with _changing(pk, revision) as draft:
        if draft.states.filter(number=draft.position + step).exists():
            draft.position += step
            draft.revision += 1
            draft.save()
    return draft


@contextmanager
def _changing(pk: int, revision: int) -> Iterator[VideoSync]:
    with transaction.atomic():
        draft = VideoSync.objects.select_for_update().get(pk=pk)
        if draft.revision != revision:
            raise StaleDraft(draft)
        yield draft


def _add(draft: VideoSync, state: State) -> None:
    draft.states.filter(number__gt=draft.position).delete()
    draft.position += 1
    draft.revision += 1
    VideoSyncState.objects.create(sync=draft, number=draft.position, content=state.as_json())
    draft.save()


def _with_files(state: State, files: list[str]) -> State:
    known = {clock.file: clock for clock in state.clocks}
    clocks = tuple(known.get(file) or _first_clock(file) for file in files)
    return replace(state, clocks=clocks) if set(known) <= set(files) else State(clocks)


def _first_clock(file: str) -> Clock:
    return Clock(file, camera_name(file))


def _facts(source: sources.Source, path: Path) -> dict[str, Any]:
    """By the header and the first picture: nobody waits for an hour-long video to be read."""
    try:
        capture = opened(source.path / path)
    except VideoError as error:
        raise SyncRefused(f"{path}: {error}.") from error
    rate, count = capture.get(cv2.CAP_PROP_FPS), capture.get(cv2.CAP_PROP_FRAME_COUNT)
    if not (0 < rate <= FASTEST and count >= 1):
        raise SyncRefused(_("%(path)s does not tell how long it is.") % {"path": path})
    start = VideoReader(capture, 1 / rate).grab()
    if start is None:
        raise SyncRefused(_("%(path)s holds no picture that can be decoded.") % {"path": path})
    status = (source.path / path).stat()
    return {
        "file": str(path),
        "width": int(capture.get(cv2.CAP_PROP_FRAME_WIDTH)),
        "height": int(capture.get(cv2.CAP_PROP_FRAME_HEIGHT)),
        "start": round(max(start, 0.0), 6),
        "interval": 1 / rate,
        "duration": count / rate,
        "version": f"{status.st_size:x}-{status.st_mtime_ns:x}",
    }
