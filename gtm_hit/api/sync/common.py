"""What the endpoints of clocks share."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from django.http import Http404

from gtm_hit.api.common.staff import StaffView, invalid
from gtm_hit.models import ApiToken, VideoSync
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.datasets.videos.video import VideoError
from gtm_hit.ops.sync import drafts
from gtm_hit.ops.sync.guessing import SyncRefused


class SyncView(StaffView):
    """As imports of videos: for maintainers of all datasets."""

    read_role = write_role = Role.MAINTAINER
    everywhere = True
    write_scope = ApiToken.Scope.IMPORT


def draft_or_404(pk: int) -> VideoSync:
    found = VideoSync.objects.filter(pk=pk).first()
    if found is None:
        raise Http404
    return found


@contextmanager
def told(place: str) -> Iterator[None]:
    """What an operation refuses, as the answer's details."""
    try:
        yield
    except drafts.StaleDraft:
        raise
    except (SyncRefused, VideoError) as error:
        raise invalid(place, error) from error
