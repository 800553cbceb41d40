"""Programs over the browser's modules, run by a page: for what node cannot import or has no canvas for."""

from __future__ import annotations

from typing import Any

from playwright.sync_api import Page


def run(page: Page, modules: dict[str, str], body: str) -> Any:
    """Evaluate a function body with names imported from modules below static/."""
    imports = "".join(
        f'const {{{names}}} = await import("/static/{module}.js");' for module, names in modules.items()
    )
    return page.evaluate(f"async () => {{ {imports} {body} }}")
