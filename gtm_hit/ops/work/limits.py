"""How often something may be tried. Tries count before they are judged, so that many at once are many."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import timedelta

from django.utils import timezone

from gtm_hit.models import Attempt
from gtm_hit.ops.work.digests import digest

KEPT = timedelta(days=1)


@dataclass(frozen=True)
class Limit:
    """At most `most` tries within `span`, for each list of parts (a name, an address)."""

    name: str
    most: int
    span: timedelta

    def wait(self, *parts: str) -> timedelta | None:
        """How long until the next try may be; None: now."""
        now = timezone.now()
        tries = Attempt.objects.filter(key=self.key(*parts), at__gt=now - self.span)
        last = tries.order_by("-at").values_list("at", flat=True)[: self.most]
        return last[self.most - 1] + self.span - now if len(last) == self.most else None

    def count(self, *parts: str) -> int:
        """Returns the try's number, by which `forget` takes it back."""
        Attempt.objects.filter(at__lt=timezone.now() - KEPT).delete()
        return Attempt.objects.create(key=self.key(*parts)).pk

    def clear(self, *parts: str) -> None:
        Attempt.objects.filter(key=self.key(*parts)).delete()

    def key(self, *parts: str) -> str:
        return digest(self.name, *parts)


def forget(tries: list[int]) -> None:
    Attempt.objects.filter(pk__in=tries).delete()
