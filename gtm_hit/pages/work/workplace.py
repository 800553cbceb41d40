"""A worker's way: entry link, start page, tutorial, workbench, code. Only a pressed button takes anything."""

from __future__ import annotations

from collections.abc import Callable
from datetime import timedelta
from functools import wraps
from typing import Any

from django.http import HttpRequest, HttpResponse, QueryDict
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import get_script_prefix, path, reverse
from django.views.decorators.cache import never_cache
from django.views.decorators.csrf import csrf_exempt, csrf_protect
from django.views.decorators.http import require_http_methods, require_POST, require_safe

from gtm_hit.crowd.entry import is_preview, worker_id
from gtm_hit.crowd.platform import Outcome, Stay
from gtm_hit.crowd.platforms import platform_of
from gtm_hit.models import Worker
from gtm_hit.ops.access.roles import SEES, layers_of
from gtm_hit.ops.campaigns import account, entry_rules
from gtm_hit.ops.campaigns import links as campaign_links
from gtm_hit.ops.frames import parts
from gtm_hit.ops.qualifications import requirements
from gtm_hit.ops.review import comments
from gtm_hit.ops.tutorial import lesson
from gtm_hit.ops.work import assignments, limits, links, unsaved_leases, workers
from gtm_hit.pages.common import browsers
from gtm_hit.pages.common.access import needs
from gtm_hit.pages.common.address import client_address
from gtm_hit.pages.common.catalog import workbench_catalog
from gtm_hit.pages.common.modules import imported_by
from gtm_hit.pages.work import arrivals, embedding, leaving

# Whoever tries out ids of others is stopped; at a lab of two hundred a few come with another browser.
NOT_PROVEN = limits.Limit("not proven", 60, timedelta(hours=1))

View = Callable[..., HttpResponse]


def valid_links_only(view: View) -> View:
    """A link that is not ours, cut off or revoked gets a page that says what to do."""

    @wraps(view)
    def guarded(request: HttpRequest, *args: Any, **kwargs: Any) -> HttpResponse:
        try:
            return view(request, *args, **kwargs)
        except links.BadToken:
            return render(request, "work/bad_link.html", status=404)

    return guarded


@require_http_methods(["GET", "HEAD", "POST"])
@csrf_exempt
@never_cache
@valid_links_only
def join(request: HttpRequest, token: str) -> HttpResponse:
    """Whoever is told by a browser or login is protected by it; a submission's id needs no cookie."""
    entry = links.read_entry(token)
    if arrivals.needs_no_cookie(entry):
        return arrivals.arrive(request, entry)
    if entry.campaign and entry.external_id is None and platform_of(entry.campaign).by_login:
        return redirect("my-work")
    return join_in_browser(request, entry)


@csrf_protect
def join_in_browser(request: HttpRequest, entry: links.Entry) -> HttpResponse:
    given = request.POST if request.method == "POST" else request.GET
    external_id = entry.external_id or named(entry, given)
    context = {
        "dataset": entry.dataset,
        "campaign": entry.campaign,
        "external_id": external_id,
        "ask": not external_id,
        "preview": entry.campaign is None and is_preview(request.GET),
        "tutorial": lesson.available(),
    }
    if context["preview"]:
        return render(request, "work/join.html", context)
    try:
        if found := whoever_enters(request, entry, external_id):
            return found
    except workers.InvalidWorkerId as error:
        return render(request, "work/join.html", {**context, "ask": True, "problem": str(error)}, status=400)
    if entry.closed:
        return render(request, "work/closed.html", context, status=410)
    return render(request, "work/join.html", context)


def named(entry: links.Entry, given: QueryDict) -> str:
    """Who the address or the form says it is."""
    if entry.campaign is None:
        return worker_id(given)
    return platform_of(entry.campaign).arrival(given).external_id


def whoever_enters(request: HttpRequest, entry: links.Entry, external_id: str) -> HttpResponse | None:
    """The way on for those who may go on; who else is known here, nobody learns by opening a link."""
    if entry.external_id:
        return personal_entry(request, entry, entry.external_id)
    secret = browsers.secret_of(request)
    if external_id and (worker := workers.proven(entry.platform, external_id, secret)):
        return to_home(worker, entry)
    if request.method != "POST" or entry.closed:
        return None
    return first_entry(request, entry, external_id)


def personal_entry(request: HttpRequest, entry: links.Entry, external_id: str) -> HttpResponse | None:
    if request.method != "POST" and workers.find(entry.platform, external_id) is None:
        return None
    secret = browsers.secret_of(request)
    return browsers.remember(to_home(workers.enter(entry.platform, external_id, secret), entry), secret)


def first_entry(request: HttpRequest, entry: links.Entry, external_id: str) -> HttpResponse:
    address = client_address(request)
    if wait := NOT_PROVEN.wait(address):
        return render(request, "work/not_proven.html", {"wait": wait}, status=429)
    secret = browsers.secret_of(request)
    try:
        worker = workers.enter_by_general_link(entry.platform, external_id, secret)
    except workers.NotProven:
        NOT_PROVEN.count(address)
        return render(request, "work/not_proven.html", status=403)
    if entry.link:
        campaign_links.used(entry.link)
    return browsers.remember(to_home(worker, entry), secret)


def to_home(worker: Worker, entry: links.Entry) -> HttpResponse:
    return redirect("work-home", token=links.seat_token(links.Seat(worker, entry.dataset, entry.campaign)))


@require_safe
@never_cache
@valid_links_only
def home(request: HttpRequest, token: str) -> HttpResponse:
    seat = links.read_worker(token)
    return embedding.framed(start_page(request, seat, token), seat.campaign)


def start_page(request: HttpRequest, seat: links.Seat, token: str) -> HttpResponse:
    current = assignments.current(seat.worker, seat.pool)
    finished = list(assignments.finished(seat.worker, seat.pool))
    if seat.submission and finished and not current:
        return leaving.finished(request, seat, finished[0])
    left = assignments.work_left(seat.worker, seat.pool)
    end = leaving.exit_of(seat, Outcome.COMPLETED, finished[0].code or "") if finished else Stay()
    context = {
        "token": token,
        "dataset": seat.dataset,
        "campaign": seat.campaign,
        "worker": seat.worker,
        "current": current,
        "done": len(assignments.done_frames(current)) if current else 0,
        "total": current.batch.frames.count() if current else 0,
        "finished": finished,
        "decisions": [(one, links.assignment_token(one)) for one in finished],
        "summary": assignments.summary(finished[0]) if finished and not current else None,
        "work_left": current is not None or left,
        "one_more": current is not None and left and assignments.room_for_another(seat.worker, seat.pool),
        "tutorial": lesson.available(),
        "refusal": entry_rules.refusal(seat.campaign, seat.worker) if seat.campaign else None,
        **leaving.shown(end),
        **what_came_of_it(seat),
        "qualifications": requirements.offered(seat.dataset).exists(),
    }
    return render(request, "work/home.html", context)


def what_came_of_it(seat: links.Seat) -> dict[str, Any]:
    """The worker's account, and the way to the first open comment."""
    if seat.campaign is None:
        return {}
    found = account.of(seat.campaign, seat.worker)
    return {"account": found, "commented": links.assignment_token(found.commented) if found.commented else ""}


@require_POST
@csrf_exempt  # the key is in the address, and who has it needs no cookie
@valid_links_only
def start(request: HttpRequest, token: str) -> HttpResponse:
    seat = links.read_worker(token)
    return embedding.framed(take(request, seat, token), seat.campaign)


def take(request: HttpRequest, seat: links.Seat, token: str) -> HttpResponse:
    context: dict[str, Any] = {"token": token, "dataset": seat.dataset}
    another = request.POST.get("another") == "yes"
    try:
        assignment = assignments.claim(seat.worker, seat.pool, client_address(request), another)
    except unsaved_leases.TooManyUnsaved:
        return render(request, "work/too_many.html", context, status=429)
    except entry_rules.NotAdmitted as error:
        return leaving.refused(request, seat, Outcome.NOT_ADMITTED, error.refusal.text, token)
    except assignments.NoFreeBatch:
        if seat.submission and assignments.finished(seat.worker, seat.pool).exists():
            return redirect("work-home", token=token)
        if seat.submission:
            return leaving.refused(request, seat, Outcome.NO_WORK, "", token)
        return render(request, "work/no_batch.html", context)
    except assignments.BusyElsewhere as busy:
        context["dataset"] = busy.assignment.batch.dataset
        context["link"] = reverse("annotate", args=[links.assignment_token(busy.assignment)])
        return render(request, "work/busy.html", context)
    return redirect("annotate", token=links.assignment_token(assignment, seat.submit_to))


@require_safe
@never_cache
@valid_links_only
def learn(request: HttpRequest, token: str) -> HttpResponse:
    seat = links.read_worker(token)
    home_url = reverse("work-home", args=[token])
    if not lesson.available():
        return redirect(home_url)
    page = workbench(request, api=api("tutorial/"), token=token, mode="tutorial", home=home_url)
    return embedding.framed(page, seat.campaign)


@require_safe
@never_cache
@valid_links_only
def annotate(request: HttpRequest, token: str) -> HttpResponse:
    task = links.read_task(token)
    seat_token, campaign = links.seat_token(task.seat), task.seat.campaign
    if assignments.read_only_reason(task.assignment) == "expired":
        page = render(request, "work/expired.html", {"token": seat_token, "assignment": task.assignment})
        return embedding.framed(page, campaign)
    home_url = reverse("work-home", args=[seat_token])
    told = "true" if comments.exist(task.assignment) else ""
    where = {"api": api("assignment/"), "token": token, "home": home_url}
    page = workbench(request, mode="assignment", comments=told, **where)
    return embedding.framed(page, campaign)


@require_safe
@needs(SEES)
@never_cache
def layer(request: HttpRequest, slug: str, name: str) -> HttpResponse:
    found = get_object_or_404(layers_of(request.user), dataset__slug=slug, name=name)
    home_url = reverse("dataset-layers", args=[slug])
    asked = request.GET.get("from", "")
    part = parts.part_of(found, int(asked) if asked.isdecimal() and len(asked) < 10 else None)
    address = api(f"layers/{found.pk}/") + (f"from/{part.first}/" if part else "")
    return workbench(request, api=address, token="", mode="layer", home=home_url)


def api(path: str) -> str:
    return f"{get_script_prefix()}api/v1/{path}"


def workbench(request: HttpRequest, **context: str) -> HttpResponse:
    parts = {"catalog": workbench_catalog(request), "modules": imported_by("workbench/main.js")}
    return render(request, "workbench.html", {**context, **parts})


urlpatterns = [
    path("join/<str:token>/", join, name="join"),
    path("work/<str:token>/", home, name="work-home"),
    path("work/<str:token>/start/", start, name="work-start"),
    path("work/<str:token>/tutorial/", learn, name="work-tutorial"),
    path("annotate/<str:token>/", annotate, name="annotate"),
    path("datasets/<slug:slug>/layers/<str:name>/", layer, name="layer"),
]
