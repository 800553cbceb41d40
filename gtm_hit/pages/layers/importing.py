"""Annotations of other programs into a layer."""

from __future__ import annotations

from django import forms
from django.conf import settings
from django.contrib.auth.models import User
from django.http import HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.http import require_http_methods

from gtm_hit.formats.problems import FormatError
from gtm_hit.models import Job
from gtm_hit.models.dataset import name_validator
from gtm_hit.ops.access.jobs import jobs_of
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.files import sources
from gtm_hit.ops.layers import job as importing
from gtm_hit.ops.layers.findings import Kind
from gtm_hit.pages.common.access import StaffRequest
from gtm_hit.pages.common.uploads import takes_uploads
from gtm_hit.pages.datasets.listing import dataset_or_404

JOBS_SHOWN = 10
FORMATS = [
    ("wildtrack", gettext_lazy("WILDTRACK: a folder of JSON per frame")),
    ("mot", gettext_lazy("MOTChallenge: VIEW/gt/gt.txt or VIEW.txt, or a file of people on the ground")),
    ("coco", gettext_lazy("COCO: a JSON file per view, or one of all")),
    ("csv", gettext_lazy("CSV in metres: frame,person,x,y")),
    ("text", gettext_lazy("Text: frame column row, and person if known")),
]
DROPS = [
    (Kind.OUTSIDE.value, gettext_lazy("people outside the grid")),
    (Kind.UNKNOWN_FRAMES.value, gettext_lazy("frames the dataset does not have")),
    (Kind.UNKNOWN_CAMERAS.value, gettext_lazy("cameras the dataset does not have")),
    (Kind.DUPLICATES.value, gettext_lazy("people who are in a frame already")),
]


class AnnotationsForm(forms.Form):
    file = forms.FileField(label=gettext_lazy("File, or zip of a folder"), required=False)
    source = forms.ChoiceField(label=gettext_lazy("Or what is on the server"), required=False)
    format = forms.ChoiceField(label=gettext_lazy("Format"), choices=FORMATS)
    layer = forms.CharField(
        label=gettext_lazy("Name of the new layer"),
        max_length=120,
        validators=[name_validator],
        initial="imported",
    )
    hidden = forms.BooleanField(label=gettext_lazy("never show this layer to workers"), required=False)
    drop = forms.MultipleChoiceField(
        label=gettext_lazy("Leave out instead of stopping"),
        choices=DROPS,
        required=False,
        widget=forms.CheckboxSelectMultiple,
    )

    def __init__(self, user: User, *args: object, **kwargs: object) -> None:
        super().__init__(*args, **kwargs)  # type: ignore[arg-type]
        found = [(each.key, each.key) for each in sources.offered(user)]
        self.fields["source"].choices = [("", "–"), *found]  # type: ignore[attr-defined]

    def clean(self) -> None:
        super().clean()
        if bool(self.cleaned_data.get("file")) == bool(self.cleaned_data.get("source")):
            raise forms.ValidationError(_("Choose a file, or something on the server."))


@require_http_methods(["GET", "HEAD", "POST"])
@takes_uploads(Role.MAINTAINER)
def import_annotations(request: StaffRequest, slug: str) -> HttpResponse:
    dataset = dataset_or_404(slug)
    form = AnnotationsForm(request.user, request.POST or None, request.FILES or None)
    if request.method == "POST" and form.is_valid() and (source := _chosen(form)):
        chosen = form.cleaned_data
        drop = [Kind(name) for name in chosen["drop"]]
        try:
            job = importing.start(
                dataset, source, chosen["format"], chosen["layer"], drop, chosen["hidden"], request.user
            )
        except importing.AnnotationImportError as error:
            form.add_error("layer", str(error))
        else:
            return redirect("job", pk=job.pk)
    context = {
        "section": "datasets",
        "tab": "layers",
        "dataset": dataset,
        "form": form,
        "incoming": settings.INCOMING_ROOT,
        "most_megabytes": settings.MAX_UPLOAD_MB,
        "most_bytes": sources.most_bytes(),
        "jobs": jobs_of(request.user).filter(dataset=dataset, kind=Job.Kind.IMPORT_ANNOTATIONS)[:JOBS_SHOWN],
    }
    return render(request, "staff/annotation_import.html", context)


def _chosen(form: AnnotationsForm) -> sources.Source | None:
    """What was just uploaded, or the source on the server; None with the form's errors."""
    upload = form.cleaned_data.get("file")
    if not upload:
        return sources.source(form.cleaned_data["source"])
    try:
        return importing.keep(upload)
    except FormatError as error:
        for problem in error.problems:
            form.add_error("file", str(problem))
        return None


urlpatterns = [
    path("datasets/<slug:slug>/import-annotations/", import_annotations, name="import-annotations"),
]
