"""A figure as it is printed, for those who have no browser to draw it."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from tempfile import NamedTemporaryFile

from PIL import ImageFont

ZOOM = 3  # pixels of the picture for one of the figure


def png(figure: str) -> bytes:
    """PNG of one of our SVGs: black on white, also where the machine has no fonts."""
    import resvg_py  # only whoever wants a picture needs it

    family, data = _own_font()
    # The font that travels with Pillow has letters and figures, but no minus sign.
    plain = figure.replace("<svg ", '<svg color="#000" ', 1).replace("−", "-")
    with NamedTemporaryFile(suffix=".ttf") as font:
        Path(font.name).write_bytes(data)
        return resvg_py.svg_to_bytes(
            svg_string=plain,
            background="#fff",
            zoom=ZOOM,
            font_files=[font.name],
            sans_serif_family=family,
        )


@lru_cache(maxsize=1)
def _own_font() -> tuple[str, bytes]:
    font = ImageFont.load_default(12)
    assert isinstance(font, ImageFont.FreeTypeFont)
    return str(font.getname()[0]), font.path.getvalue()  # type: ignore[union-attr]
