"""What a page gives to be kept as a file."""

from __future__ import annotations

from django.http import HttpResponse


def attachment(content: str | bytes, content_type: str, name: str) -> HttpResponse:
    """Names of datasets, layers and campaigns hold nothing that would need quoting."""
    headers = {"Content-Disposition": f'attachment; filename="{name}"'}
    return HttpResponse(content, content_type=content_type, headers=headers)


def csv_attachment(text: str, name: str) -> HttpResponse:
    return attachment(text, "text/csv; charset=utf-8", name)
