"""Two text files of positions against each other, as `manage.py evaluate` compares them."""

from __future__ import annotations

from typing import Any

from django import forms
from django.core.files.uploadedfile import UploadedFile
from django.http import HttpRequest, HttpResponse
from django.shortcuts import render
from django.urls import path
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_http_methods

from gtm_hit.formats.problems import FormatError
from gtm_hit.metrics.annotations import MetricsError
from gtm_hit.metrics.matching import RADIUS
from gtm_hit.ops.access.roles import SEES
from gtm_hit.ops.quality.text_files import MOST_UPLOADED, evaluate_uploads
from gtm_hit.pages.common.uploads import takes_uploads


class TextFilesForm(forms.Form):
    truth = forms.FileField(label=gettext_lazy("Truth"), allow_empty_file=True)
    found = forms.FileField(label=gettext_lazy("Compared with it"), allow_empty_file=True)
    step = forms.FloatField(label=gettext_lazy("Step of the grid, metres"), initial=0.025)
    radius = forms.FloatField(label=gettext_lazy("Radius, metres"), initial=RADIUS)
    identities = forms.BooleanField(
        label=gettext_lazy("Lines have a person, too: compare identities"), required=False
    )

    def clean_truth(self) -> UploadedFile:
        return self._small("truth")

    def clean_found(self) -> UploadedFile:
        return self._small("found")

    def _small(self, name: str) -> UploadedFile:
        file: UploadedFile = self.cleaned_data[name]
        if (file.size or 0) > MOST_UPLOADED:
            text = _("The file is larger than %(size)d MB; manage.py evaluate takes longer ones.")
            raise forms.ValidationError(text % {"size": MOST_UPLOADED // 1_000_000})
        return file


@require_http_methods(["GET", "HEAD", "POST"])
@never_cache
@takes_uploads(SEES)
def evaluate_files(request: HttpRequest) -> HttpResponse:
    form = TextFilesForm(request.POST or None, request.FILES or None)
    scores: dict[str, Any] = {}
    if request.method == "POST" and form.is_valid():
        try:
            scores = evaluate_uploads(**form.cleaned_data, curve=True)
        except MetricsError as error:
            form.add_error(None, str(error))
        except FormatError as error:
            for problem in error.problems:
                form.add_error(None, str(problem))
    curve = scores.pop("curve", [])
    context = {"section": "datasets", "form": form, "scores": scores, "curve": curve}
    return render(request, "staff/evaluate.html", context)


urlpatterns = [path("evaluate/", evaluate_files, name="evaluate-files")]
