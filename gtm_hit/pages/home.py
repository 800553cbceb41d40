from __future__ import annotations

from django.http import HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.views.decorators.http import require_safe

from gtm_hit.ops.access.roles import SEES, Role, may


@require_safe
def home(request: HttpRequest) -> HttpResponse:
    """Leads people to where their work is."""
    if may(request.user, SEES):
        return redirect("datasets")
    if may(request.user, Role.ANNOTATOR):
        return redirect("my-work")
    return render(request, "home.html", {"waits": request.user.is_authenticated})


urlpatterns = [path("", home, name="home")]
