from __future__ import annotations

from django.contrib import admin
from django.contrib.auth.views import LogoutView
from django.urls import include, path
from django.views.generic import RedirectView

from gtm_hit.pages.common.login import LimitedLogin

urlpatterns = [
    # One door: what limits and logs one login does so for all.
    path("admin/login/", RedirectView.as_view(pattern_name="login", query_string=True)),
    path("admin/", admin.site.urls),
    path("login/", LimitedLogin.as_view(), name="login"),
    path("logout/", LogoutView.as_view(), name="logout"),
    path("api/v1/", include("gtm_hit.api.urls")),
    path("", include("gtm_hit.pages.urls")),
]

handler500 = "gtm_hit.pages.common.failure.failed"
