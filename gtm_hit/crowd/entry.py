"""How crowd platforms open an entry link: where they put their worker's id, and how a preview looks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(frozen=True)
class Preview:
    """A parameter and the value it has while somebody only looks at the task."""

    parameter: str
    value: str


@dataclass(frozen=True)
class Platform:
    name: str
    worker_parameters: tuple[str, ...]
    preview: Preview | None = None

    def shows_preview(self, address: Mapping[str, str]) -> bool:
        return self.preview is not None and address.get(self.preview.parameter) == self.preview.value


PLATFORMS = (
    Platform("link", ("worker_id",)),
    Platform(
        "Mechanical Turk and panels that speak its protocol",
        ("workerId",),
        Preview("assignmentId", "ASSIGNMENT_ID_NOT_AVAILABLE"),
    ),
    Platform("Prolific", ("PROLIFIC_PID",)),
    Platform("panels that name a participant", ("participant_id",)),
)


def worker_id(given: Mapping[str, str]) -> str:
    """Of the first platform whose parameter is filled in; empty when there is none."""
    names = (name for platform in PLATFORMS for name in platform.worker_parameters)
    return next((given[name] for name in names if given.get(name)), "")


def is_preview(address: Mapping[str, str]) -> bool:
    return any(platform.shows_preview(address) for platform in PLATFORMS)
