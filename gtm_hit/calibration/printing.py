"""A board on paper, in its true size: the page both writers draw, as SVG or PDF."""

from __future__ import annotations

from dataclasses import dataclass
from xml.sax.saxutils import escape

from gtm_hit.calibration.artwork import Dot, Extent, Square, extent, shapes
from gtm_hit.calibration.boards import Board, describe

# Millimetres.
SHEETS = (
    ("A4", 210.0, 297.0),
    ("A3", 297.0, 420.0),
    ("A2", 420.0, 594.0),
    ("A1", 594.0, 841.0),
    ("A0", 841.0, 1189.0),
)
MARGIN = 0.5  # white around the board, in spacings; the rest of the sheet is white too
EDGE = 8.0  # printers leave that white
FOOT = 22.0  # ruler and words
RULER = 100.0
LETTERS = 3.6
ADVICE = (
    "Print at 100 %, without fitting to the page, and glue it onto something flat. The bar is 100 mm long."
)


@dataclass(frozen=True)
class Box:
    x: float
    y: float
    width: float
    height: float
    black: bool = True


@dataclass(frozen=True)
class Circle:
    x: float
    y: float
    radius: float
    black: bool = True


@dataclass(frozen=True)
class Words:
    x: float
    y: float  # of the base line
    text: str


Mark = Box | Circle | Words


@dataclass(frozen=True)
class Page:
    """Millimetres, y downwards, in the order of painting."""

    name: str  # the sheet
    width: float
    height: float
    marks: tuple[Mark, ...]


def page(board: Board) -> Page:
    """The board in the middle of the smallest sheet it fits, with a ruler and what it is."""
    area = extent(board, MARGIN)
    wide, high = (area.right - area.left) * 1000, (area.bottom - area.top) * 1000
    name, width, height = _sheet(wide, high)
    left, top = (width - wide) / 2, EDGE + (height - FOOT - 2 * EDGE - high) / 2
    marks = _board_marks(board, area, left, top)
    return Page(name, width, height, (*marks, *_foot(board, name, height)))


def _sheet(wide: float, high: float) -> tuple[str, float, float]:
    needed = (max(wide, RULER) + 2 * EDGE, high + FOOT + 2 * EDGE)
    for name, short, long in SHEETS:
        for width, height in ((short, long), (long, short)):
            if needed[0] <= width and needed[1] <= height:
                return name, width, height
    return "larger than A0", *needed


def _board_marks(board: Board, area: Extent, left: float, top: float) -> list[Mark]:
    shift = (left - area.left * 1000, top - area.top * 1000)
    marks: list[Mark] = []
    if board.inverted:
        marks.append(Box(left, top, (area.right - area.left) * 1000, (area.bottom - area.top) * 1000))
    return marks + [_mark(shape, shift, board.inverted) for shape in shapes(board)]


def _mark(shape: Square | Dot, shift: tuple[float, float], inverted: bool) -> Mark:
    x, y = shape.x * 1000 + shift[0], shape.y * 1000 + shift[1]
    if isinstance(shape, Dot):
        return Circle(x, y, shape.radius * 1000, not inverted)
    return Box(x, y, shape.side * 1000, shape.side * 1000, shape.black != inverted)


def _foot(board: Board, name: str, height: float) -> list[Mark]:
    base = height - EDGE - FOOT
    marks: list[Mark] = [Box(EDGE, base + 5, RULER, 0.3)]
    for tick in range(11):
        length = 3.0 if tick % 5 == 0 else 1.8
        marks.append(Box(EDGE + 10 * tick - (0.15 if tick else 0), base + 5 - length, 0.15, length))
    marks.append(Words(EDGE + RULER + 3, base + 5.3, "100 mm"))
    marks.append(Words(EDGE, base + 12, f"{describe(board)}. Sheet: {name}."))
    return [*marks, Words(EDGE, base + 18, ADVICE)]


def board_svg(board: Board) -> str:
    """The page as SVG, in millimetres."""
    paper = page(board)
    size = f'width="{paper.width:g}mm" height="{paper.height:g}mm"'
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" {size} viewBox="0 0 {paper.width:g} {paper.height:g}">',
        f"<title>{escape(describe(board))}</title>",
        f'<rect width="{paper.width:g}" height="{paper.height:g}" fill="#fff"/>',
        f'<g font-family="Helvetica, Arial, sans-serif" font-size="{LETTERS}">',
    ]
    return "\n".join([*lines, *(_svg(mark) for mark in paper.marks), "</g>", "</svg>", ""])


def _svg(mark: Mark) -> str:
    if isinstance(mark, Words):
        return f'<text x="{mark.x:.4f}" y="{mark.y:.4f}">{escape(mark.text)}</text>'
    fill = "#000" if mark.black else "#fff"
    if isinstance(mark, Circle):
        return f'<circle cx="{mark.x:.4f}" cy="{mark.y:.4f}" r="{mark.radius:.4f}" fill="{fill}"/>'
    return (
        f'<rect x="{mark.x:.4f}" y="{mark.y:.4f}" width="{mark.width:.4f}" '
        f'height="{mark.height:.4f}" fill="{fill}"/>'
    )
