"""A calibration board on paper, in its true size."""

from __future__ import annotations

from base64 import b64encode
from typing import Any

from django import forms
from django.http import HttpResponse
from django.shortcuts import render
from django.urls import path
from django.utils.translation import gettext_lazy
from django.views.decorators.http import require_safe

from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.desk import board_choices, boards, preview
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.pages.common.access import StaffRequest, needs

USUAL = {"kind": "chessboard", "columns": 9, "rows": 6, "spacing": 25}


class BoardKindForm(forms.Form):
    """Which board it is; lengths are millimetres."""

    kind = forms.ChoiceField(label=gettext_lazy("Board"), choices=board_choices.KINDS)
    columns = forms.IntegerField(label=gettext_lazy("Columns"), min_value=1)
    rows = forms.IntegerField(label=gettext_lazy("Rows"), min_value=1)
    spacing = forms.FloatField(label=gettext_lazy("Spacing, mm"), min_value=0.1)
    marker = forms.FloatField(
        label=gettext_lazy("Marker, share of a square"), required=False, help_text=gettext_lazy("ChArUco")
    )
    dictionary = forms.ChoiceField(
        label=gettext_lazy("Dictionary"),
        choices=[("", "–"), *board_choices.DICTIONARIES],
        required=False,
        help_text=gettext_lazy("ChArUco"),
    )
    inverted = forms.BooleanField(label=gettext_lazy("White printed on black"), required=False)
    legacy = forms.BooleanField(label=gettext_lazy("Made by OpenCV before 4.6"), required=False)

    def board(self) -> Any:
        """Raises DeskError."""
        given = {name: value for name, value in self.cleaned_data.items() if value not in (None, "")}
        return boards.board_of({**given, "spacing": given["spacing"] / 1000})


@require_safe
@needs(Role.MAINTAINER)
def board(request: StaffRequest) -> HttpResponse:
    kind = request.GET.get("as", "")
    form = BoardKindForm(request.GET if "columns" in request.GET else USUAL)
    picture = b""
    if form.is_valid():
        try:
            picture = preview.sheet(form.board(), kind or "svg")
        except DeskError as error:
            form.add_error(None, str(error))
    if picture and kind in preview.SHEETS:
        answer = HttpResponse(picture, content_type=preview.SHEETS[kind])
        answer["Content-Disposition"] = f'attachment; filename="board.{kind}"'
        return answer
    encoded = b64encode(picture).decode() if picture and not kind else ""
    context = {"section": "datasets", "form": form, "picture": encoded}
    return render(request, "desk/board.html", context)


urlpatterns = [path("calibration-board/", board, name="board-sheet")]
