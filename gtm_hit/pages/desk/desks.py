"""Desks there are, a new one, and how far one is."""

from __future__ import annotations

from typing import Any

from django import forms
from django.core.paginator import Paginator
from django.http import HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_http_methods, require_POST, require_safe

from gtm_hit.models import Dataset
from gtm_hit.ops.access.desks import desks_of
from gtm_hit.ops.access.roles import Role, Somebody, datasets_of, may_everywhere
from gtm_hit.ops.desk import checks, desks, overview
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.common.fields import AddressNameField
from gtm_hit.pages.desk.common import desk_or_404, frame, tried

ROWS_PER_PAGE = 50


class DeskForm(forms.Form):
    slug = AddressNameField(label=gettext_lazy("Name in addresses"), max_length=80)
    title = forms.CharField(label=gettext_lazy("Title"), max_length=200, required=False)
    dataset = forms.ModelChoiceField(
        Dataset.objects.none(),
        label=gettext_lazy("For the cameras of"),
        required=False,
        to_field_name="slug",
        empty_label=gettext_lazy("a dataset that is not there yet"),
    )
    cameras = forms.CharField(
        label=gettext_lazy("Names of the cameras, without a dataset"),
        max_length=4000,
        required=False,
        help_text=gettext_lazy("As the folders of their pictures will be called, for instance: C1 C2 C3"),
    )

    def __init__(self, user: Somebody, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        field: Any = self.fields["dataset"]
        field.queryset = datasets_of(user, Role.MAINTAINER)
        self._everywhere = may_everywhere(user, Role.MAINTAINER)
        if not self._everywhere:
            field.empty_label = _("choose one")

    def clean_dataset(self) -> Dataset | None:
        found: Dataset | None = self.cleaned_data["dataset"]
        if found is None and not self._everywhere:
            raise forms.ValidationError(
                _("Choose a dataset: without one it takes a maintainer of all datasets.")
            )
        return found


@require_http_methods(["GET", "HEAD", "POST"])
@needs(Role.MAINTAINER)
def desk_list(request: StaffRequest) -> HttpResponse:
    form = DeskForm(request.user, request.POST or None, initial={"dataset": request.GET.get("dataset")})
    if request.method == "POST" and form.is_valid():
        cleaned = form.cleaned_data
        names = cleaned["cameras"].replace(",", " ").split()
        try:
            made = desks.make(cleaned["slug"], cleaned["title"], cleaned["dataset"], names, request.user)
            return redirect("desk", desk=made.slug)
        except DeskError as error:
            form.add_error(None, str(error))
    found = desks_of(request.user).select_related("dataset", "created_by")
    page = Paginator(found, ROWS_PER_PAGE).get_page(request.GET.get("page"))
    context = {
        "section": "datasets",
        "form": form,
        "page": page,
        "rows": [(desk, overview.overview(desk)) for desk in page],
    }
    return render(request, "desk/list.html", context)


@require_safe
@never_cache
@needs(Role.MAINTAINER)
def desk(request: StaffRequest, desk: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    context = {
        **frame(found, "desk"),
        "found": overview.overview(found),
        "check": checks.step(found),
        "edits": found.edits.select_related("author").order_by("-number")[:10],
    }
    return render(request, "desk/overview.html", context)


@require_POST
@needs(Role.MAINTAINER)
def add_camera(request: StaffRequest, desk: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    name = request.POST.get("name", "").strip()
    tried(request, lambda: desks.add_camera(found, name))
    return redirect("desk", desk=desk)


@require_POST
@needs(Role.MAINTAINER)
def remove_camera(request: StaffRequest, desk: str, camera: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    tried(request, lambda: desks.remove_camera(found, camera))
    return redirect("desk", desk=desk)


@require_POST
@needs(Role.MAINTAINER)
def remove(request: StaffRequest, desk: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    tried(request, lambda: desks.remove(found), _("The desk is removed."))
    return redirect("desks")


urlpatterns = [
    path("calibration-desks/", desk_list, name="desks"),
    path("calibration-desks/<slug:desk>/", desk, name="desk"),
    path("calibration-desks/<slug:desk>/cameras/", add_camera, name="desk-add-camera"),
    path(
        "calibration-desks/<slug:desk>/cameras/<str:camera>/remove/",
        remove_camera,
        name="desk-remove-camera",
    ),
    path("calibration-desks/<slug:desk>/remove/", remove, name="desk-remove"),
]
