"""Every layer's refusals have one root, which those above can catch."""

from __future__ import annotations

import importlib
import inspect
from pathlib import Path

import pytest

from gtm_hit.geometry.errors import GeometryError
from gtm_hit.ops.errors import OperationError
from tests.conftest import REPOSITORY


def modules(layer: str) -> list[str]:
    files = sorted((REPOSITORY / "gtm_hit" / layer).rglob("*.py"))
    named = [file.relative_to(REPOSITORY).with_suffix("") for file in files if file.stem != "__init__"]
    return [".".join(Path(name).parts) for name in named]


@pytest.mark.parametrize(("layer", "root"), [("ops", OperationError), ("geometry", GeometryError)])
def test_every_refusal_of_a_layer_descends_from_its_root(layer: str, root: type[Exception]) -> None:
    found = [
        one
        for name in modules(layer)
        for one in vars(importlib.import_module(name)).values()
        if inspect.isclass(one) and issubclass(one, Exception) and one.__module__ == name
    ]
    assert len(found) > 3
    assert [one for one in found if not issubclass(one, root)] == []
