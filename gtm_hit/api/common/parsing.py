"""Bodies of requests: JSON of a bounded size, and nothing in it that breaks the reader."""

from __future__ import annotations

import io
from collections.abc import Mapping
from typing import Any

from django.utils.translation import gettext as _
from rest_framework import status
from rest_framework.exceptions import APIException, ParseError
from rest_framework.parsers import JSONParser, MultiPartParser

MAX_BYTES = 1024 * 1024  # 500 people take a tenth of it
FORM_BYTES = 1_000_000  # around the files of a form, generously


class TooLarge(APIException):
    status_code = status.HTTP_413_REQUEST_ENTITY_TOO_LARGE
    default_code = "too_large"


class BoundedJSONParser(JSONParser):
    def parse(
        self, stream: Any, media_type: str | None = None, parser_context: Mapping[str, Any] | None = None
    ) -> Any:
        body = stream.read(MAX_BYTES + 1)
        if len(body) > MAX_BYTES:
            raise TooLarge(_("The request is larger than 1 MB."))
        try:
            return super().parse(io.BytesIO(body), media_type, parser_context)
        except RecursionError:
            raise ParseError(_("The JSON is nested too deeply.")) from None


class BoundedMultiPartParser(MultiPartParser):
    """A form with files; looks at its length before it takes the body in."""

    def most_bytes(self) -> int:
        """Of all files together."""
        raise NotImplementedError

    def parse(self, stream: Any, media_type: Any = None, parser_context: Any = None) -> Any:
        most = self.most_bytes()
        if int(parser_context["request"].META.get("CONTENT_LENGTH") or 0) > most + FORM_BYTES:
            raise TooLarge(_("The file is larger than %(size)d MB.") % {"size": most // 1_000_000})
        return super().parse(stream, media_type, parser_context)
