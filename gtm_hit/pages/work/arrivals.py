"""The entry of a campaign's workers whose platform, not their browser, says who they are.

Nothing here reads or sets a cookie: the page may stand in another site's frame, where there are none. Who
knows a submission's id owns its seat, and the seat's address is the key from there on.
"""

from __future__ import annotations

from django.http import HttpRequest, HttpResponse
from django.shortcuts import redirect, render

from gtm_hit.crowd.platform import Arrival, ArrivalError
from gtm_hit.crowd.platforms import platform_of
from gtm_hit.models import Campaign, Worker
from gtm_hit.ops.campaigns import links as campaign_links
from gtm_hit.ops.tutorial import lesson
from gtm_hit.ops.work import links, workers
from gtm_hit.pages.work.embedding import framed


def needs_no_cookie(entry: links.Entry) -> bool:
    campaign = entry.campaign
    return campaign is not None and entry.external_id is None and platform_of(campaign).by_submission


def arrive(request: HttpRequest, entry: links.Entry) -> HttpResponse:
    """A page to press Start on; pressed, the seat. Looking at it makes nothing."""
    assert entry.campaign is not None
    return framed(answer(request, entry, entry.campaign), entry.campaign)


def answer(request: HttpRequest, entry: links.Entry, campaign: Campaign) -> HttpResponse:
    context = {"dataset": entry.dataset, "campaign": campaign, "tutorial": lesson.available()}
    try:
        arrival = platform_of(campaign).arrival(request.GET)
        if arrival.preview:
            return render(request, "work/join.html", {**context, "preview": True})
        if seated := known(campaign, arrival):
            return to_seat(seated, campaign, arrival)
        if entry.closed:
            return render(request, "work/closed.html", context, status=410)
        if request.method != "POST":
            # The form goes to the address as it is, with what the platform wrote into it.
            return render(request, "work/join.html", {**context, "action": request.get_full_path()})
        worker = workers.enter(campaign.platform, arrival.external_id)
    except (ArrivalError, workers.InvalidWorkerId) as error:
        return render(request, "work/not_arrived.html", {**context, "problem": str(error)}, status=400)
    if entry.link:
        campaign_links.used(entry.link)
    return to_seat(worker, campaign, arrival)


def known(campaign: Campaign, arrival: Arrival) -> Worker | None:
    """Who has begun this submission already."""
    worker = workers.find(campaign.platform, arrival.external_id)
    if worker is None:
        return None
    pool = links.Seat(worker, campaign.dataset, campaign, arrival.submission).pool
    return worker if pool.mine(worker).exists() else None


def to_seat(worker: Worker, campaign: Campaign, arrival: Arrival) -> HttpResponse:
    seat = links.Seat(worker, campaign.dataset, campaign, arrival.submission, arrival.submit_to)
    return redirect("work-home", token=links.seat_token(seat))


def arrival_of(seat: links.Seat) -> Arrival:
    """What the seat remembers of how its worker came."""
    return Arrival(seat.worker.external_id, seat.submission, seat.submit_to)
