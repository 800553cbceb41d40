"""Workers by their scores, and assignments by what speaks against them."""

from __future__ import annotations

from typing import Any

from django.contrib import messages
from django.core.paginator import Paginator
from django.http import HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.utils.translation import gettext as _
from django.views.decorators.http import require_POST, require_safe

from gtm_hit.models import Assignment, WorkerScore
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.files.csv_text import csv_text
from gtm_hit.ops.scores import listing, words
from gtm_hit.ops.scores.suspicion import by_suspicion
from gtm_hit.pages.common.access import needs
from gtm_hit.pages.common.attachments import csv_attachment
from gtm_hit.pages.common.campaign_choice import campaign_or_404
from gtm_hit.pages.gold import frame_of

ROWS_PER_PAGE = 100


@require_safe
@needs(Role.MANAGER)
def campaign_scores(request: HttpRequest, slug: str, name: str) -> HttpResponse:
    campaign = campaign_or_404(slug, name)
    page = Paginator(listing.workers(campaign), ROWS_PER_PAGE).get_page(request.GET.get("page"))
    rows = [(row.worker.pseudonym, words.shown(row)) for row in page.object_list]
    context = {**frame_of(campaign), "page": page, "rows": rows, "here_quality": "campaign-scores"}
    return render(request, "campaigns/scores.html", context)


@require_safe
@needs(Role.MANAGER)
def campaign_scores_csv(request: HttpRequest, slug: str, name: str) -> HttpResponse:
    campaign = campaign_or_404(slug, name)
    header = ["worker", "score", "low", "high", "assignments", "why"]
    lines = (score_line(row) for row in listing.workers(campaign))
    return csv_attachment(csv_text(header, lines), f"{slug}-{name}-scores.csv")


def score_line(row: WorkerScore) -> list[Any]:
    numbers = [round(value, 1) for value in (row.score, row.low, row.high)]
    return [row.worker.pseudonym, *numbers, row.assignments, " ".join(words.of_score(row))]


@require_POST
@needs(Role.MANAGER)
def recompute(request: HttpRequest, slug: str, name: str) -> HttpResponse:
    try:
        number = listing.recompute_now(campaign_or_404(slug, name))
        messages.success(request, _("Measured anew: %(count)d assignments.") % {"count": number})
    except listing.TooMuch as error:
        messages.error(request, str(error))
    return redirect("campaign-scores", slug, name)


@require_safe
@needs(Role.MANAGER)
def campaign_suspicion(request: HttpRequest, slug: str, name: str) -> HttpResponse:
    campaign = campaign_or_404(slug, name)
    page = Paginator(by_suspicion(campaign), ROWS_PER_PAGE).get_page(request.GET.get("page"))
    rows = [(one, *doubts(one)) for one in page.object_list]
    context = {**frame_of(campaign), "page": page, "rows": rows, "here_quality": "campaign-suspicion"}
    return render(request, "campaigns/suspicion.html", context)


@require_safe
@needs(Role.MANAGER)
def campaign_suspicion_csv(request: HttpRequest, slug: str, name: str) -> HttpResponse:
    campaign = campaign_or_404(slug, name)
    header = ["batch", "copy", "worker", "state", "submitted", "layer", "suspicion", "why"]
    lines = (suspicion_line(one) for one in by_suspicion(campaign))
    return csv_attachment(csv_text(header, lines), f"{slug}-{name}-suspicion.csv")


def suspicion_line(one: Assignment) -> list[Any]:
    percent, told = doubts(one)
    submitted = one.submitted_at.isoformat(timespec="seconds") if one.submitted_at else ""
    what = [one.batch.number, one.batch.copy, one.worker.pseudonym, one.state, submitted, one.layer.name]
    return [*what, "" if percent is None else percent / 100, " ".join(told)]


def doubts(one: Assignment) -> tuple[int | None, list[str]]:
    """Percent and reasons; none for work nobody measured yet."""
    score = getattr(one, "score", None)
    return (None, []) if score is None else (round(100 * score.suspicion), words.of_suspicion(score))


CAMPAIGN = "datasets/<slug:slug>/campaigns/<str:name>/"
urlpatterns = [
    path(f"{CAMPAIGN}scores/", campaign_scores, name="campaign-scores"),
    path(f"{CAMPAIGN}scores.csv", campaign_scores_csv, name="campaign-scores-csv"),
    path(f"{CAMPAIGN}scores/recompute/", recompute, name="campaign-scores-recompute"),
    path(f"{CAMPAIGN}suspicion/", campaign_suspicion, name="campaign-suspicion"),
    path(f"{CAMPAIGN}suspicion.csv", campaign_suspicion_csv, name="campaign-suspicion-csv"),
]
