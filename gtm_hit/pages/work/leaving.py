"""How a worker leaves: with a code, by an address, by a form, or not at all."""

from __future__ import annotations

from typing import Any

from django.http import HttpRequest, HttpResponse
from django.shortcuts import render

from gtm_hit.crowd.platform import Exit, FormPost, Outcome, Redirect, ShowCode, Stay
from gtm_hit.crowd.platforms import platform_of
from gtm_hit.models import Assignment
from gtm_hit.ops.work import assignments, links
from gtm_hit.pages.work.arrivals import arrival_of


def exit_of(seat: links.Seat, outcome: Outcome, code: str = "") -> Exit:
    if seat.campaign is None:
        return ShowCode(code) if code else Stay()
    return platform_of(seat.campaign).leave(outcome, code, arrival_of(seat))


def shown(way: Exit) -> dict[str, Any]:
    """For templates: which of the four it is, by its name."""
    names = {ShowCode: "code", Redirect: "redirect", FormPost: "form", Stay: "stay"}
    return {"way": names[type(way)], "exit": way}


def finished(request: HttpRequest, seat: links.Seat, assignment: Assignment) -> HttpResponse:
    """The end of a submission whose platform takes it from here."""
    way = exit_of(seat, Outcome.COMPLETED, assignment.code or "")
    summary = assignments.summary(assignment)
    context = {"dataset": seat.dataset, "campaign": seat.campaign, "summary": summary, **shown(way)}
    return render(request, "work/leave.html", {**context, "code": assignment.code})


def refused(request: HttpRequest, seat: links.Seat, outcome: Outcome, text: str, token: str) -> HttpResponse:
    """No batch for this worker: what the platform is told, and what they read."""
    context = {"dataset": seat.dataset, "campaign": seat.campaign, "text": text, "token": token}
    return render(request, "work/refused.html", {**context, **shown(exit_of(seat, outcome))})
