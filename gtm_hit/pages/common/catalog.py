"""The workbench's texts in the reader's language, as its page carries them."""

from __future__ import annotations

import json
from typing import Any

from django.http import HttpRequest
from django.views.i18n import JSONCatalog

COUNTED = 200  # plural rules look at the last two digits only: from 100 on they repeat


class WorkbenchCatalog(JSONCatalog):
    """Django's catalog, with the plural rule worked out: the page evaluates no expressions."""

    packages = ["gtm_hit"]

    def get_context_data(self, **kwargs: Any) -> dict[str, Any]:
        plural = self.translation.plural
        return {
            "catalog": self.get_catalog(),
            "plurals": "".join(str(plural(number)) for number in range(COUNTED)),
        }


def workbench_catalog(request: HttpRequest) -> dict[str, Any]:
    view = WorkbenchCatalog()
    view.setup(request)
    return dict(json.loads(view.get(request).content))
