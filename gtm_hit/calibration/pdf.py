"""A page of boxes, circles and words as PDF 1.4; more is not needed, so no library is."""

from __future__ import annotations

from gtm_hit.calibration.boards import Board, describe
from gtm_hit.calibration.printing import LETTERS, Box, Circle, Mark, Page, Words, page

POINT = 72 / 25.4  # per millimetre
ROUND = 0.5522847498  # where a quarter circle's control points are


def board_pdf(board: Board) -> bytes:
    """The page as PDF. The same board gives the same bytes."""
    paper = page(board)
    content = "\n".join(_drawn(mark, paper) for mark in paper.marks).encode("cp1252", "replace")
    size = f"[0 0 {paper.width * POINT:.4f} {paper.height * POINT:.4f}]"
    title = _quoted(describe(board)).encode("cp1252", "replace")
    return _file(
        [
            b"<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
            b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
            f"<< /Type /Page /Parent 2 0 R /MediaBox {size} /Contents 4 0 R "
            "/Resources << /Font << /F1 5 0 R >> >> >>".encode(),
            b"<< /Length %d >>\nstream\n%s\nendstream" % (len(content), content),
            b"<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
            b"<< /Title (%s) >>" % title,
        ]
    )


def _file(objects: list[bytes]) -> bytes:
    data = b"%PDF-1.4\n%\xe2\xe3\xcf\xd3\n"
    places = []
    for number, content in enumerate(objects, start=1):
        places.append(len(data))
        data += b"%d 0 obj\n%s\nendobj\n" % (number, content)
    table = b"".join(b"%010d 00000 n \n" % place for place in places)
    count = len(objects) + 1
    end = b"trailer\n<< /Size %d /Root 1 0 R /Info %d 0 R >>\nstartxref\n%d\n%%%%EOF\n"
    return (
        data
        + b"xref\n0 %d\n0000000000 65535 f \n%s" % (count, table)
        + end % (count, len(objects), len(data))
    )


def _drawn(mark: Mark, paper: Page) -> str:
    """PDF's operators; its y grows upwards."""
    if isinstance(mark, Words):
        x, y = mark.x * POINT, (paper.height - mark.y) * POINT
        return f"BT 0 g /F1 {LETTERS * POINT:.3f} Tf {x:.4f} {y:.4f} Td ({_quoted(mark.text)}) Tj ET"
    colour = "0 g" if mark.black else "1 g"
    return f"{colour} {_circle(mark, paper) if isinstance(mark, Circle) else _box(mark, paper)} f"


def _box(box: Box, paper: Page) -> str:
    numbers = (box.x, paper.height - box.y - box.height, box.width, box.height)
    return " ".join(f"{number * POINT:.4f}" for number in numbers) + " re"


def _circle(circle: Circle, paper: Page) -> str:
    x, y, r = circle.x, paper.height - circle.y, circle.radius
    k = ROUND * r
    curves = [
        (x + r, y + k, x + k, y + r, x, y + r),
        (x - k, y + r, x - r, y + k, x - r, y),
        (x - r, y - k, x - k, y - r, x, y - r),
        (x + k, y - r, x + r, y - k, x + r, y),
    ]
    path = [f"{(x + r) * POINT:.4f} {y * POINT:.4f} m"]
    path += [" ".join(f"{number * POINT:.4f}" for number in curve) + " c" for curve in curves]
    return " ".join(path)


def _quoted(text: str) -> str:
    return text.replace("\\", "\\\\").replace("(", "\\(").replace(")", "\\)")
