"""Qualifications of a dataset for its managers: made, changed, closed, granted, revoked."""

from __future__ import annotations

from typing import Any

from django import forms
from django.contrib import messages
from django.core.paginator import Paginator
from django.http import Http404, HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.http import require_http_methods, require_POST

from gtm_hit.models import Dataset, Qualification
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.errors import OperationError
from gtm_hit.ops.gold.truths import truths
from gtm_hit.ops.qualifications import grants, managing
from gtm_hit.ops.qualifications.managing import Order, PassMarks, QualificationError
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.datasets.listing import dataset_or_404

ROWS_PER_PAGE = 100


class MarksForm(forms.Form):
    title = forms.CharField(label=gettext_lazy("Title for workers"), max_length=200, required=False)
    tries = forms.IntegerField(label=gettext_lazy("Tries"), min_value=1, max_value=100, initial=2)
    recall = forms.FloatField(
        label=gettext_lazy("People found, at least %"), min_value=0, max_value=100, initial=90
    )
    precision = forms.FloatField(
        label=gettext_lazy("Boxes with a person, at least %"), min_value=0, max_value=100, initial=90
    )
    identity = forms.FloatField(
        label=gettext_lazy("Identities (IDF1), at least %"), min_value=0, max_value=100, initial=80
    )
    median = forms.FloatField(
        label=gettext_lazy("Median distance, at most cm"), min_value=1, max_value=50, initial=15
    )
    p95 = forms.FloatField(
        label=gettext_lazy("95 % within, at most cm"), min_value=1, max_value=50, initial=40
    )

    def marks(self) -> PassMarks:
        given = {name: self.cleaned_data[name] / 100 for name in PERCENT}
        return PassMarks(*given.values())


PERCENT = ("recall", "precision", "median", "p95", "identity")


class NewForm(MarksForm):
    name = forms.CharField(label=gettext_lazy("Name"), max_length=120)
    layer = forms.ChoiceField(label=gettext_lazy("Layer with the truth"))
    first_frame = forms.IntegerField(label=gettext_lazy("From frame"), min_value=0, initial=0)
    frames_per_try = forms.IntegerField(
        label=gettext_lazy("Frames per try"), min_value=1, max_value=100, initial=5
    )
    field_order = ["name", "title", "layer", "first_frame", "frames_per_try", "tries"]

    def __init__(self, dataset: Dataset, data: Any = None) -> None:
        super().__init__(data)
        names = truths(dataset).values_list("name", flat=True)[:200]
        self.fields["layer"].choices = [(name, name) for name in names]  # type: ignore[attr-defined]

    def order(self, dataset: Dataset) -> Order:
        given = self.cleaned_data
        return Order(
            name=given["name"],
            truth=truths(dataset).get(name=given["layer"]),
            title=given["title"],
            first_frame=given["first_frame"],
            frames_per_try=given["frames_per_try"],
            tries=given["tries"],
            marks=self.marks(),
        )


def qualification_or_404(slug: str, name: str) -> Qualification:
    found = Qualification.objects.filter(dataset__slug=slug, name=name).select_related("dataset", "truth")
    # PostgreSQL has no strings with a zero byte and fails instead of finding nothing.
    if (one := None if "\x00" in name else found.first()) is None:
        raise Http404(_("There is no qualification “%(name)s”.") % {"name": name})
    return one


@require_http_methods(["GET", "HEAD", "POST"])
@needs(Role.MANAGER)
def dataset_qualifications(request: StaffRequest, slug: str) -> HttpResponse:
    dataset = dataset_or_404(slug)
    form = NewForm(dataset, request.POST or None)
    if request.method == "POST" and form.is_valid():
        try:
            made = managing.create(dataset, form.order(dataset), request.user)
            return redirect("dataset-qualification", slug, made.name)
        except QualificationError as error:
            form.add_error(None, str(error))
    context = {
        "section": "datasets",
        "tab": "qualifications",
        "dataset": dataset,
        "form": form,
        "rows": list(managing.qualifications(dataset)),
    }
    status = 400 if request.method == "POST" else 200
    return render(request, "staff/qualifications.html", context, status=status)


@require_http_methods(["GET", "HEAD", "POST"])
@needs(Role.MANAGER)
def dataset_qualification(request: HttpRequest, slug: str, name: str) -> HttpResponse:
    qualification = qualification_or_404(slug, name)
    form = MarksForm(request.POST or None, initial=as_given(qualification))
    if request.method == "POST" and form.is_valid():
        try:
            given = form.cleaned_data
            managing.change(qualification, form.marks(), given["tries"], given["title"])
            messages.success(request, _("Tries from now on are judged by these marks."))
            return redirect("dataset-qualification", slug, name)
        except QualificationError as error:
            form.add_error(None, str(error))
    page = Paginator(grants.standing(qualification), ROWS_PER_PAGE).get_page(request.GET.get("page"))
    context = {
        "section": "datasets",
        "tab": "qualifications",
        "dataset": qualification.dataset,
        "qualification": qualification,
        "form": form,
        "page": page,
        "tries": list(managing.tries(qualification)[:ROWS_PER_PAGE]),
        "frame_count": qualification.frames.count(),
    }
    status = 400 if request.method == "POST" else 200
    return render(request, "staff/qualification.html", context, status=status)


def as_given(one: Qualification) -> dict[str, Any]:
    marks = (one.min_recall, one.min_precision, one.max_median, one.max_p95, one.min_idf1)
    shown = {name: round(100 * value, 1) for name, value in zip(PERCENT, marks, strict=True)}
    return {"title": one.title, "tries": one.tries, **shown}


@require_POST
@needs(Role.MANAGER)
def decide(request: StaffRequest, slug: str, name: str) -> HttpResponse:
    """Grant, revoke, close or open again; what is refused is said on the page."""
    qualification = qualification_or_404(slug, name)
    try:
        messages.success(request, decided(request, qualification))
    except OperationError as error:
        messages.error(request, str(error))
    return redirect("dataset-qualification", slug, name)


def decided(request: StaffRequest, qualification: Qualification) -> str:
    match request.POST.get("what"):
        case "close":
            managing.close(qualification)
            return _("Closed: no new tries. What was granted stays.")
        case "reopen":
            managing.reopen(qualification)
            return _("Open: workers can try again.")
        case "grant":
            worker = grants.worker_named(request.POST.get("worker", "").strip())
            grants.grant(qualification, worker, request.user, request.POST.get("why", "").strip())
            return _("%(worker)s has the qualification.") % {"worker": worker.pseudonym}
        case "revoke":
            worker = grants.worker_named(request.POST.get("worker", "").strip())
            grants.revoke(qualification, worker, request.user, request.POST.get("why", ""))
            return _("%(worker)s does not have the qualification any more.") % {"worker": worker.pseudonym}
    raise QualificationError(_("Choose what to do."))


urlpatterns = [
    path("datasets/<slug:slug>/qualifications/", dataset_qualifications, name="dataset-qualifications"),
    path(
        "datasets/<slug:slug>/qualifications/<str:name>/", dataset_qualification, name="dataset-qualification"
    ),
    path("datasets/<slug:slug>/qualifications/<str:name>/decide/", decide, name="qualification-decide"),
]
