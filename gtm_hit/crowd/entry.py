"""A dataset's own link, without a campaign: any platform may send its workers there, each in its own way."""

from __future__ import annotations

from collections.abc import Mapping

from gtm_hit.crowd import external_question, survey_link
from gtm_hit.ops.campaigns import platform_settings

WORKER_PARAMETERS = (
    survey_link.TYPED,
    external_question.WORKER,
    platform_settings.Prolific.worker_parameter,
    "participant_id",  # of panels that name a participant
)


def worker_id(given: Mapping[str, str]) -> str:
    """By the first parameter that is filled in; empty when none is."""
    return next((given[name] for name in WORKER_PARAMETERS if given.get(name)), "")


def is_preview(address: Mapping[str, str]) -> bool:
    """Somebody only looks at the task."""
    return address.get(external_question.SUBMISSION) == external_question.PREVIEW
