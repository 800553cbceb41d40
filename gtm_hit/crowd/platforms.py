"""The platform of a campaign."""

from __future__ import annotations

from gtm_hit.crowd.external_question import ExternalQuestion
from gtm_hit.crowd.own_team import OwnTeam
from gtm_hit.crowd.platform import Platform
from gtm_hit.crowd.prolific_study import Prolific
from gtm_hit.crowd.survey_link import SurveyLink
from gtm_hit.models import Campaign
from gtm_hit.ops.campaigns import platform_settings


def platform_of(campaign: Campaign) -> Platform:
    match platform_settings.read(campaign):
        case platform_settings.SurveyLink() as settings:
            return SurveyLink(settings)
        case platform_settings.ExternalQuestion() as settings:
            return ExternalQuestion(settings)
        case platform_settings.Prolific() as settings:
            return Prolific(settings)
        case platform_settings.OwnTeam():
            return OwnTeam()
