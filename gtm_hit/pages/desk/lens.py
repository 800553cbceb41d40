"""The lens of one camera: out of pictures of a board, or known already."""

from __future__ import annotations

from typing import Any
from urllib.parse import urlencode

from django import forms
from django.contrib import messages
from django.core.files.uploadedfile import UploadedFile
from django.http import HttpResponse
from django.shortcuts import get_object_or_404, redirect, render
from django.urls import path
from django.utils.translation import gettext as _
from django.utils.translation import gettext_lazy
from django.views.decorators.cache import never_cache
from django.views.decorators.http import require_http_methods, require_POST

from gtm_hit.formats.problems import FormatError
from gtm_hit.models import BoardPicture, Desk, DeskCamera
from gtm_hit.ops.access.roles import Role
from gtm_hit.ops.desk import board_choices, boards, edits, lens_job, lens_view, lenses, overview
from gtm_hit.ops.desk.errors import DeskError
from gtm_hit.ops.files import sources
from gtm_hit.pages.common.access import StaffRequest, needs
from gtm_hit.pages.common.uploads import takes_uploads
from gtm_hit.pages.desk.board import USUAL, BoardKindForm
from gtm_hit.pages.desk.common import camera_or_404, desk_or_404, frame, tried


class ManyFiles(forms.ClearableFileInput):
    allow_multiple_selected = True


class FilesField(forms.FileField):
    widget = ManyFiles

    def clean(self, data: Any, initial: Any = None) -> Any:
        one = super().clean
        files = data if isinstance(data, list | tuple) else [data]
        return [one(each, initial) for each in files if each]


class ModelForm(forms.Form):
    coefficients = forms.ChoiceField(
        label=gettext_lazy("Coefficients"), choices=board_choices.COEFFICIENTS, initial="five"
    )
    fixed_centre = forms.BooleanField(label=gettext_lazy("Principal point in the middle"), required=False)
    fixed_aspect = forms.BooleanField(label=gettext_lazy("Square pixels: fx = fy"), required=False)


class BoardForm(BoardKindForm):
    file = FilesField(label=gettext_lazy("Pictures, a zip of them, or a video"), required=False)


class LensFileForm(forms.Form):
    file = forms.FileField(label=gettext_lazy("cameras.json, or an intrinsic file of OpenCV's"))

    def clean_file(self) -> UploadedFile:
        file: UploadedFile = self.cleaned_data["file"]
        if (file.size or 0) > lenses.MOST_BYTES:
            raise forms.ValidationError(_("The file is too large to be a lens."))
        return file


@require_http_methods(["GET", "HEAD", "POST"])
@never_cache
@takes_uploads(Role.MAINTAINER)
def desk_lens(request: StaffRequest, desk: str, camera: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    row = camera_or_404(found, camera)
    form = BoardForm(request.POST or None, request.FILES or None, initial=_initial(row))
    if request.method == "POST" and form.is_valid():
        try:
            board = form.board()
            files = form.cleaned_data["file"]
            sent = lens_job.keep_upload(files) if files else ""
            lens_job.start(found, camera, board, boards.model_of(row), sent, request.user)
            return redirect("desk-lens", desk=desk, camera=camera)
        except DeskError as error:
            form.add_error(None, str(error))
        except FormatError as error:
            for problem in error.problems:
                form.add_error("file", str(problem))
    return render(request, "desk/lens.html", _context(request, found, row, form))


@require_POST
@needs(Role.MAINTAINER)
def switch_picture(request: StaffRequest, desk: str, camera: str, picture: int) -> HttpResponse:
    found = desk_or_404(request, desk)
    kept = get_object_or_404(BoardPicture, camera=camera_or_404(found, camera), pk=picture)
    tried(request, lambda: boards.switch(found, camera, kept.name, not kept.used, request.user))
    return redirect("desk-lens", desk=desk, camera=camera)


@require_POST
@needs(Role.MAINTAINER)
def change_lens(request: StaffRequest, desk: str, camera: str, what: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    row = camera_or_404(found, camera)
    page, user = edits.lens_page(camera), request.user
    form = ModelForm(request.POST)
    operations = {
        "undo": lambda: edits.undo(found, page),
        "redo": lambda: edits.redo(found, page),
        "in-place": lambda: lenses.put_in_place(found, camera, user),
        "choose": lambda: boards.use_chosen(found, camera, user),
        "remove-pictures": lambda: boards.remove_all(found, camera),
    }
    if what == "model" and form.is_valid():
        model = board_choices.model_of(form.cleaned_data)
        tried(request, lambda: boards.use_model(found, row.name, model, user))
    elif what in operations:
        tried(request, operations[what])
    return redirect("desk-lens", desk=desk, camera=camera)


@require_POST
@takes_uploads(Role.MAINTAINER)
def put_lens_file(request: StaffRequest, desk: str, camera: str) -> HttpResponse:
    found = desk_or_404(request, desk)
    camera_or_404(found, camera)
    form = LensFileForm(request.POST, request.FILES)
    if form.is_valid():
        file = form.cleaned_data["file"]
        tried(
            request,
            lambda: lenses.put_file(found, camera, file.read(), file.name, request.user),
            _("The lens is that of the file now."),
        )
    else:
        messages.error(request, " ".join(map(str, form.errors.get("file", []))))
    return redirect("desk-lens", desk=desk, camera=camera)


def _context(request: StaffRequest, desk: Desk, row: DeskCamera, form: BoardForm) -> dict[str, Any]:
    pictures = boards.pictures_of(desk, row.name)
    job = lens_job.jobs_of(desk, row.name).first()
    chosen = next((each for each in pictures if str(each.pk) == request.GET.get("view")), None)
    steps = edits.steps(desk, edits.lens_page(row.name))
    step = overview.lens_step(row)
    running = job is not None and not job.finished
    return {
        **frame(desk, "lens"),
        "camera": row,
        "names": list(desk.cameras.values_list("name", flat=True)),
        "form": form,
        "model_form": ModelForm(initial=boards.model_of(row).as_json()),
        "file_form": LensFileForm(),
        "step": step,
        "next_step": overview.overview(desk).next_step if step.usable and not running else None,
        "report": row.lens_report,
        "parameters": lens_view.parameters(row),
        "bars": lens_view.bars(row, pictures),
        "found": sum(each.found is not None for each in pictures),
        "board_query": urlencode(form.initial),
        "searched": any(each.searched for each in pictures),
        "cells": lens_view.cells(row),
        "chosen": chosen,
        "arrows": lens_view.arrows(row, chosen) if chosen else [],
        "longer": lens_view.LONGER,
        "job": job,
        "percent": 100 * job.done // job.total if job and job.total else 0,
        "undo": steps.undo,
        "redo": steps.redo,
        "most_megabytes": sources.most_bytes() // sources.MEGABYTE,
    }


def _initial(row: DeskCamera) -> dict[str, Any]:
    """The board asked for last, for this camera or else for another one: most labs have one board.

    The page speaks of millimetres.
    """
    others = row.desk.cameras.filter(board__isnull=False).order_by("index").values_list("board", flat=True)
    board = (row.board or others.last() or {}).get("board")
    return {**board, "spacing": round(1000 * board["spacing"], 6)} if board else USUAL


AT = "calibration-desks/<slug:desk>/lens/<str:camera>/"

urlpatterns = [
    path(AT, desk_lens, name="desk-lens"),
    path(f"{AT}file/", put_lens_file, name="desk-lens-file"),
    path(f"{AT}pictures/<int:picture>/", switch_picture, name="desk-switch-picture"),
    path(f"{AT}<slug:what>/", change_lens, name="desk-change-lens"),
]
