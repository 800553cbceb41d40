from __future__ import annotations

from django.http import HttpRequest, HttpResponse
from django.shortcuts import redirect, render
from django.urls import path
from django.views.decorators.http import require_safe


@require_safe
def home(request: HttpRequest) -> HttpResponse:
    if request.user.is_staff:
        return redirect("datasets")
    if request.user.is_authenticated:
        return redirect("my-work")
    return render(request, "home.html")


urlpatterns = [path("", home, name="home")]
