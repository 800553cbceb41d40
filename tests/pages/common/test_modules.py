"""The page names the modules it will need."""

from __future__ import annotations

from collections import Counter

from django.contrib.staticfiles import finders

from gtm_hit.pages.common.modules import imported_by


def test_imports_of_imports_are_named_and_the_module_itself_is_not() -> None:
    found = imported_by("workbench/main.js")
    assert {"workbench/workbench.js", "views/pane.js", "geometry/rectangle.js"} <= set(found)
    assert "workbench/main.js" not in found


def test_every_module_is_named_once_and_exists() -> None:
    found = imported_by("workbench/main.js")
    assert Counter(found).most_common(1)[0][1] == 1
    assert all(finders.find(name) for name in found)


def test_parts_that_come_when_they_are_needed_are_not_named() -> None:
    assert "workbench/keys/help.js" not in imported_by("workbench/main.js")
