"""A worker's tries: begun by a button, explained afterwards over the pictures."""

from __future__ import annotations

from dataclasses import dataclass

from django.http import Http404, HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.urls import path, reverse
from django.views.decorators.cache import cache_control, never_cache
from django.views.decorators.http import require_http_methods, require_safe

from gtm_hit.models import Qualification, QualificationAttempt
from gtm_hit.ops.qualifications import attempts, crops, grants, judging, mistakes, requirements
from gtm_hit.ops.work import assignments, links
from gtm_hit.pages.work.workplace import valid_links_only


@dataclass(frozen=True)
class Offer:
    qualification: Qualification
    held: bool
    tried: int
    running: bool

    @property
    def left(self) -> int:
        return max(0, self.qualification.tries - self.tried)


def offer(qualification: Qualification, seat: links.Seat) -> Offer:
    tried = list(attempts.attempts(qualification, seat.worker))
    running = any(one.passed is None for one in tried)
    return Offer(qualification, grants.holds(qualification, seat.worker), len(tried), running)


@require_safe
@never_cache
@valid_links_only
def work_qualifications(request: HttpRequest, token: str) -> HttpResponse:
    seat = links.read_worker(token)
    offers = [offer(one, seat) for one in requirements.offered(seat.dataset)]
    context = {"token": token, "dataset": seat.dataset, "offers": offers}
    return render(request, "work/qualifications.html", context)


@require_http_methods(["GET", "HEAD", "POST"])
@never_cache
@valid_links_only
def work_qualification(request: HttpRequest, token: str, name: str) -> HttpResponse:
    seat = links.read_worker(token)
    qualification = qualification_or_404(seat, name)
    if request.method == "POST":
        return begun(request, token, seat, qualification)
    return result_page(request, token, seat, qualification, "")


def begun(request: HttpRequest, token: str, seat: links.Seat, qualification: Qualification) -> HttpResponse:
    try:
        assignment = attempts.begin(qualification, seat.worker)
    except assignments.BusyElsewhere as busy:
        link = reverse("annotate", args=[links.assignment_token(busy.assignment)])
        context = {"dataset": busy.assignment.batch.dataset, "link": link}
        return render(request, "work/busy.html", context)
    except attempts.NoMoreTries as error:
        return result_page(request, token, seat, qualification, str(error))
    return redirect("annotate", token=links.assignment_token(assignment))


def result_page(
    request: HttpRequest, token: str, seat: links.Seat, qualification: Qualification, problem: str
) -> HttpResponse:
    """The newest judged try, or nothing but the button."""
    judged = attempts.attempts(qualification, seat.worker).filter(passed__isnull=False).first()
    shown, count = mistakes.shown_mistakes(judged) if judged else ([], 0)
    context = {
        "token": token,
        "dataset": seat.dataset,
        "offer": offer(qualification, seat),
        "qualification": qualification,
        "attempt": judged,
        "marks": judging.marks(judged) if judged else [],
        "mistakes": shown,
        "count": count,
        "more": count - len(shown),
        "problem": problem,
    }
    return render(request, "work/qualification.html", context, status=409 if problem else 200)


def qualification_or_404(seat: links.Seat, name: str) -> Qualification:
    found = Qualification.objects.filter(dataset=seat.dataset, name=name).select_related("dataset").first()
    if found is None:
        raise Http404
    return found


@require_safe
@valid_links_only
@cache_control(private=True, max_age=3600)
def mistake_picture(
    request: HttpRequest,
    token: str,
    name: str,
    number: int,
    frame: int,
    camera: int,
    x: int,
    y: int,
    size: int,
) -> HttpResponse:
    seat = links.read_worker(token)
    mine = attempts.attempts(qualification_or_404(seat, name), seat.worker)
    attempt: QualificationAttempt | None = mine.filter(number=number).first()
    picture = crops.crop(attempt, frame, camera, (x, y, size, size)) if attempt else None
    if picture is None:
        raise Http404
    return HttpResponse(picture, content_type="image/jpeg")


urlpatterns = [
    path("work/<str:token>/qualifications/", work_qualifications, name="work-qualifications"),
    path("work/<str:token>/qualifications/<str:name>/", work_qualification, name="work-qualification"),
    path(
        "work/<str:token>/qualifications/<str:name>/<int:number>/<int:frame>/<int:camera>/<int:x>-<int:y>-<int:size>.jpg",
        mistake_picture,
        name="work-mistake-picture",
    ),
]
