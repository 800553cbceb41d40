"""Requests nobody would think of: no answer is a 500, and none is undocumented."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Iterator
from typing import Any

import pytest
import schemathesis
from django.core.signals import request_finished, request_started
from django.core.wsgi import get_wsgi_application
from django.db import close_old_connections
from drf_spectacular.generators import SchemaGenerator
from drf_spectacular.renderers import OpenApiJsonRenderer
from hypothesis import HealthCheck, Phase, given, settings
from schemathesis.checks import not_a_server_error
from schemathesis.specs.openapi.checks import (
    content_type_conformance,
    response_schema_conformance,
    status_code_conformance,
)

from gtm_hit.models import Layer
from tests.api.conftest import bearer
from tests.work_scene import row, save

CHECKS = [
    not_a_server_error,
    status_code_conformance,
    content_type_conformance,
    response_schema_conformance,
]
EXAMPLES = 6  # of every operation; more by hand when the API changes much
KNOWN = {"slug": "square", "name": "own", "number": 5, "pk": 1}


@pytest.fixture
def kept_connection() -> Iterator[None]:
    """Requests share the test's transaction, which ends with its connection."""
    signals = (request_started, request_finished)
    for signal in signals:
        signal.disconnect(close_old_connections)
    yield
    for signal in signals:
        signal.connect(close_old_connections)


def described() -> Any:
    text = OpenApiJsonRenderer().render(SchemaGenerator().get_schema(public=True), renderer_context={})
    return schemathesis.openapi.from_dict(json.loads(text), config=None)


def test_no_request_breaks_the_api_or_its_description(
    layer: Layer, kept_connection: None, capsys: pytest.CaptureFixture[str]
) -> None:
    save(layer, layer.dataset.frames.get(number=5), [row()])
    script = bearer("read", "import", "work", "release")
    schema = described()
    schema.app = get_wsgi_application()
    answered: Counter[int] = Counter()
    for result in schema.get_all_operations():
        ask(result.ok(), script.headers, layer.pk, answered)
    with capsys.disabled():
        print(f"\nschemathesis: {answered.total()} requests, answers {dict(sorted(answered.items()))}")
    assert answered[200] > 30


def ask(operation: Any, headers: dict[str, str], layer: int, answered: Counter[int]) -> None:
    @settings(
        max_examples=EXAMPLES,
        deadline=None,
        database=None,
        derandomize=True,
        phases=[Phase.generate],
        suppress_health_check=list(HealthCheck),
    )
    @given(case=operation.as_strategy())
    def asked(case: Any) -> None:
        # Half of the questions are about what there is.
        if answered.total() % 2:
            known = {**KNOWN, "layer": layer}
            case.path_parameters = {
                name: known.get(name, value) for name, value in (case.path_parameters or {}).items()
            }
        # It offers to unpack what is compressed, but in this process nobody does.
        response = case.call(headers={**headers, "Accept-Encoding": "identity"})
        answered[response.status_code] += 1
        case.validate_response(response, checks=CHECKS)

    asked()
