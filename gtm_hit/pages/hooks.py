"""Messages of platforms. Whoever cannot sign with the campaign's secret is nobody."""

from __future__ import annotations

from django.http import HttpRequest, HttpResponse
from django.urls import path
from django.views.decorators.csrf import csrf_exempt
from django.views.decorators.http import require_POST

from gtm_hit.crowd import prolific_hooks
from gtm_hit.models import PlatformAccount
from gtm_hit.ops.outbox import statuses

MOST_BYTES = 64 * 1024


@csrf_exempt
@require_POST
def prolific(request: HttpRequest, slug: str, name: str) -> HttpResponse:
    accounts = PlatformAccount.objects.select_related("campaign")
    account = accounts.filter(campaign__dataset__slug=slug, campaign__name=name).first()
    if int(request.META.get("CONTENT_LENGTH") or 0) > MOST_BYTES:
        return HttpResponse(status=413)
    headers = request.headers
    signed_at = headers.get("X-Prolific-Request-Timestamp", "")
    given = headers.get("X-Prolific-Request-Signature", "")
    # A campaign that is not there looks like one whose secret is not known.
    secret = account.hook_secret if account else ""
    if account is None or not prolific_hooks.is_signed(secret, signed_at, request.body, given):
        return HttpResponse(status=403)
    try:
        told = prolific_hooks.read(
            request.body, headers.get("X-Event-ID", ""), signed_at, headers.get("X-Timestamp", "")
        )
    except prolific_hooks.NotAMessage as error:
        return HttpResponse(str(error), status=400, content_type="text/plain")
    change = statuses.Told(told.subject, told.participant, told.status, told.at)
    statuses.take_in(account.campaign, told.event, told.kind, change)
    return HttpResponse(status=204)


urlpatterns = [path("hooks/prolific/<slug:slug>/<str:name>/", prolific, name="hook-prolific")]
