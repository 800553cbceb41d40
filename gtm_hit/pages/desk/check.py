"""Clicking the same thing in several views, and the points that are kept of it."""

from __future__ import annotations

from django import forms
from django.contrib import messages
from django.http import HttpResponse
from django.shortcuts import redirect, render
from django.urls import path, reverse
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_POST, require_safe

from gtm_hit.models import KeptPoint
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.desk import checks, kept
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.common.uploads import takes_uploads
from gtm_hit.pages.desk.common import desk_or_404, frame, tried


class KeptForm(forms.Form):
    file = forms.FileField(label=gettext_lazy("CSV or JSON"))
    use = forms.ChoiceField(
        label=gettext_lazy("Where the file does not say it, they are"),
        choices=[
            (KeptPoint.Use.TEST, gettext_lazy("test points")),
            (KeptPoint.Use.CORRESPONDENCE, gettext_lazy("correspondences")),
        ],
    )


@require_safe
@never_cache
@needs(Role.MAINTAINER)
def desk_check(request: StaffRequest, desk: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    around = frame(found, "check")
    context = {
        **around,
        "check": {
            "api": around["api"],
            "desk": reverse("desk", args=[found.slug]),
            "check": checks.shown(found),
            "point": request.GET.get("point", ""),
        },
        "cameras": found.cameras.count(),
        "kept_form": KeptForm(),
    }
    return render(request, "desk/check.html", context)


@require_POST
@takes_uploads(Role.MAINTAINER)
def put_kept(request: StaffRequest, desk: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    form = KeptForm(request.POST, request.FILES)
    if form.is_valid():
        given = form.cleaned_data
        file = given["file"]

        def put() -> None:
            kept.put_file(found, file.read(), file.name, given["use"], request.user)

        tried(request, put, _("The points of the file are kept."))
    for name, errors in form.errors.items():
        messages.error(request, f"{form[name].label}: {' '.join(map(str, errors))}")
    return redirect("desk-check", desk=desk)


@require_safe
@needs(Role.MAINTAINER)
def kept_csv(request: StaffRequest, desk: str) -> HttpResponse:
    answer = HttpResponse(kept.as_csv(desk_or_404(request, desk)), content_type="text/csv")
    answer["Content-Disposition"] = f'attachment; filename="{desk}-kept.csv"'
    return answer


urlpatterns = [
    path("calibration-desks/<slug:desk>/check/", desk_check, name="desk-check"),
    path("calibration-desks/<slug:desk>/check/kept/", put_kept, name="desk-kept"),
    path("calibration-desks/<slug:desk>/check/kept.csv", kept_csv, name="desk-kept-csv"),
]
