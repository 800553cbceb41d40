"""The folder tree explains the architecture; imports only go downward (design: "who may know whom")."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

APP = Path(__file__).resolve().parent.parent / "gtm_hit"
PURE = {"geometry", "formats", "metrics", "scoring", "demo", "stitching", "vision", "calibration"}
MAY_IMPORT = {
    "geometry": set(),
    "formats": {"geometry"},
    "metrics": {"geometry", "formats"},
    "scoring": {"geometry", "metrics"},
    "vision": {"geometry", "formats", "metrics"},
    "calibration": {"geometry", "formats"},
    "demo": {"geometry", "formats", "calibration"},
    "stitching": {"metrics"},
    "models": {"geometry"},
    "ops": {
        "geometry",
        "formats",
        "metrics",
        "scoring",
        "demo",
        "stitching",
        "vision",
        "calibration",
        "models",
    },
    "crowd": {"models", "ops"},
    "tasks": {"models", "ops", "crowd"},
    "api": {"geometry", "formats", "metrics", "models", "ops", "crowd"},
    "pages": {"geometry", "formats", "metrics", "models", "ops", "crowd"},
    "templatetags": {"models", "ops"},
    "management": {
        "geometry",
        "formats",
        "metrics",
        "vision",
        "calibration",
        "demo",
        "models",
        "ops",
        "crowd",
    },
    "admin": {"models", "ops"},
}
FRAMEWORKS = {"django", "rest_framework", "celery", "drf_spectacular", "annotator"}


def area_of(file: Path) -> str:
    return file.relative_to(APP).parts[0].removesuffix(".py")


def imports_of(file: Path) -> set[str]:
    names: set[str] = set()
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{file}: write imports in full"
            module = node.module or ""
            names.add(module)
            if module == "gtm_hit":
                names.update(f"gtm_hit.{alias.name}" for alias in node.names)
    return names


FILES = sorted(file for file in APP.rglob("*.py") if "migrations" not in file.parts)


@pytest.mark.parametrize("file", FILES, ids=lambda file: str(file.relative_to(APP)))
def test_a_module_imports_only_from_layers_below(file: Path) -> None:
    area = area_of(file)
    if area in {"__init__", "apps"}:
        return
    allowed = MAY_IMPORT[area] | {area}
    for name in imports_of(file):
        parts = name.split(".")
        if parts[0] == "gtm_hit" and len(parts) > 1:
            assert parts[1] in allowed, f"{area} must not know {name}"


@pytest.mark.parametrize(
    "file", [file for file in FILES if area_of(file) in PURE], ids=lambda file: str(file.relative_to(APP))
)
def test_pure_layers_know_no_framework(file: Path) -> None:
    assert not {name.split(".")[0] for name in imports_of(file)} & FRAMEWORKS


@pytest.mark.parametrize(
    "file", [file for file in FILES if area_of(file) == "ops"], ids=lambda file: str(file.relative_to(APP))
)
def test_operations_know_no_request(file: Path) -> None:
    assert not [name for name in imports_of(file) if name.startswith(("django.http", "rest_framework"))]


@pytest.mark.parametrize("file", [file for file in FILES if "ops" in file.parts], ids=lambda file: file.name)
def test_operations_import_each_other_at_the_top(file: Path) -> None:
    """An import within a function hides that two rooms know each other; what is slow to load may wait."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    within = [node for node in ast.walk(tree) if isinstance(node, ast.ImportFrom) and node not in tree.body]
    assert not [node.module for node in within if (node.module or "").startswith("gtm_hit.ops")]
