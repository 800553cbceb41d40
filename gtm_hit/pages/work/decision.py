"""What was decided about a worker's batch and why; a rejected one may object here, once."""

from __future__ import annotations

from django import forms
from django.http import HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.utils.translation import gettext_lazy
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_http_methods

from gtm_hit.models import Assignment, Comment
from gtm_hit.ops.review import needs
from gtm_hit.ops.review.comments import threads
from gtm_hit.ops.review.decision import told
from gtm_hit.ops.review.machine import Action
from gtm_hit.ops.review.refusals import ReviewRefused
from gtm_hit.ops.review.transitions import transition
from gtm_hit.ops.work import links
from gtm_hit.pages.work.workplace import valid_links_only


class AppealForm(forms.Form):
    text = forms.CharField(
        label=gettext_lazy("What was judged wrongly? Somebody else will look at your batch."),
        max_length=needs.MOST_LETTERS,
        widget=forms.Textarea(attrs={"rows": 5}),
    )


@require_http_methods(["GET", "HEAD", "POST"])
@never_cache
@valid_links_only
def decision(request: HttpRequest, token: str) -> HttpResponse:
    assignment = links.read_assignment(token)
    form = AppealForm(request.POST or None)
    problem = ""
    if request.method == "POST" and form.is_valid():
        text = form.cleaned_data["text"]
        try:
            transition(assignment, Action.APPEAL, assignment.worker, reason=text)
            return redirect("work-decision", token=token)
        except ReviewRefused as error:
            problem = str(error)
    context = {
        "token": token,
        "home": links.worker_token(assignment.worker, assignment.batch.dataset),
        "assignment": assignment,
        "dataset": assignment.batch.dataset,
        "decision": told(assignment),
        "comments": counted(assignment),
        "form": form,
        "problem": problem,
    }
    return render(request, "work/decision.html", context, status=409 if problem else 200)


def counted(assignment: Assignment) -> list[tuple[int, Comment]]:
    """The remarks, each with its frame as the workbench counts them, from 1; 0 for those about everything."""
    numbers = list(assignment.batch.frames.order_by("number").values_list("number", flat=True))
    places = {number: place for place, number in enumerate(numbers, start=1)}
    return [(places.get(one.frame.number, 0) if one.frame else 0, one) for one in threads(assignment)]


urlpatterns = [path("annotate/<str:token>/decision/", decision, name="work-decision")]
