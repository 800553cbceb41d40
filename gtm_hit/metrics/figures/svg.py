"""SVG text out of numbers: the few elements the figures are made of."""

from __future__ import annotations

import re
from typing import Any
from xml.sax.saxutils import escape, quoteattr

FONT = "Helvetica, Arial, 'Liberation Sans', sans-serif"
TEXT = 12  # pixels
SMALL = 11
# Each stands out from white and from black alike, at 3 to 1 or better.
BLUE = "#3b7dc0"
RED = "#d1495b"
AMBER = "#b87d14"
GREEN = "#3c9a6a"

_IMPOSSIBLE = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\ud800-\udfff\ufffe\uffff]")


def number(value: float) -> str:
    """At most two decimals: a hundredth of a pixel is not seen, and its rounding noise would change bytes."""
    text = f"{value:.2f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def element(name: str, content: str = "", **attributes: Any) -> str:
    """`content` is markup. Attributes are words, numbers, or None for none; `_` is written as `-`."""
    written = "".join(
        f" {key.replace('_', '-')}={quoteattr(_value(value))}"
        for key, value in attributes.items()
        if value is not None
    )
    return f"<{name}{written}>{content}</{name}>" if content else f"<{name}{written}/>"


def line(x1: float, y1: float, x2: float, y2: float, **attributes: Any) -> str:
    return element("line", x1=x1, y1=y1, x2=x2, y2=y2, **({"stroke": "currentColor"} | attributes))


def text(x: float, y: float, words: str, **attributes: Any) -> str:
    return element("text", _plain(words), x=x, y=y, **({"fill": "currentColor"} | attributes))


def text_width(words: str, size: float = TEXT) -> float:
    """Pixels, roughly: an average over Helvetica's letters and figures; nothing here measures fonts."""
    return 0.56 * size * len(words)


def document(width: float, height: float, title: str, description: str, parts: list[str]) -> str:
    """`title` and `description` are what a screen reader says in place of the picture."""
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{number(width)}" height="{number(height)}" '
        f'viewBox="0 0 {number(width)} {number(height)}" role="img" '
        f'font-family={quoteattr(FONT)} font-size="{TEXT}">'
    )
    named = [element("title", _plain(title)), element("desc", _plain(description))]
    return "\n".join([head, *named, *parts, "</svg>", ""])


def _plain(words: str) -> str:
    """Words as markup; what XML cannot hold, not even escaped, becomes the replacement character."""
    return escape(_IMPOSSIBLE.sub("\N{REPLACEMENT CHARACTER}", words))


def _value(value: str | float) -> str:
    return number(value) if isinstance(value, int | float) else str(value)
