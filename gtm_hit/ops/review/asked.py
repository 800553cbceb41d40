"""A step somebody asks for, with the assignment's row locked."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from gtm_hit.models import Assignment
from gtm_hit.ops.review.actors import Actor


@dataclass
class Asked:
    """`changes`: columns of the row that are written together with its state."""

    assignment: Assignment
    by: Actor
    category: str = ""
    reason: str = ""
    changes: dict[str, Any] = field(default_factory=dict)
