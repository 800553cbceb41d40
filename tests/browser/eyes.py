"""What stands on the workbench's screen: the boxes and words that its canvases show, and nothing else."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from playwright.sync_api import Page

PROPOSED = "#a6ff9a"  # the colour of proposals and of what speaks for them

# Canvases cannot be asked what they show, so what is drawn on them is noted down, until it is cleared away.
WATCH = """
(() => {
  const noted = new WeakMap();
  const of = (canvas) => noted.get(canvas) ?? noted.set(canvas, new Map()).get(canvas);
  const brush = CanvasRenderingContext2D.prototype;
  const { strokeRect, fillText, clearRect } = brush;
  const note = (canvas, mark) => of(canvas).set(JSON.stringify(mark), mark);
  brush.strokeRect = function (x, y, width, height) {
    const dashed = this.getLineDash().length > 0;
    const look = { colour: this.strokeStyle, line: this.lineWidth, dashed, text: null };
    note(this.canvas, { x, y, width, height, ...look });
    return strokeRect.call(this, x, y, width, height);
  };
  brush.fillText = function (text, x, y, ...more) {
    note(this.canvas, { x, y, width: 0, height: 0, colour: this.fillStyle, line: 0, dashed: false, text });
    return fillText.call(this, text, x, y, ...more);
  };
  brush.clearRect = function (x, y, width, height) {
    const marks = of(this.canvas);
    for (const [key, one] of marks) {
      const across = one.x <= x + width && one.x + one.width >= x;
      if (across && one.y <= y + height && one.y + one.height >= y) marks.delete(key);
    }
    return clearRect.call(this, x, y, width, height);
  };
  window.shownOnScreen = () =>
    [...document.querySelectorAll(".pane[data-view^=camera]:not([hidden])")].flatMap((pane) => {
      const { left, top } = pane.getBoundingClientRect();
      const view = Number(pane.dataset.view.split("-")[1]);
      const marks = [...of(pane.querySelector(".pane-marks")).values()];
      return marks.map((one) => ({ ...one, view, x: left + one.x, y: top + one.y }));
    });
})();
"""
LABEL = 20  # CSS pixels above a box in which its label stands


@dataclass(frozen=True)
class Mark:
    """A box, or words (`text`), in CSS pixels of the page."""

    view: int
    x: float
    y: float
    width: float
    height: float
    colour: str
    line: float
    dashed: bool
    text: str | None

    @property
    def foot(self) -> tuple[float, float]:
        return self.x + self.width / 2, self.y + self.height

    @property
    def middle(self) -> tuple[float, float]:
        return self.x + self.width / 2, self.y + self.height / 2


class Eyes:
    """Opened before the page is: `Eyes.on(page)`."""

    def __init__(self, page: Page) -> None:
        self._page = page

    @classmethod
    def on(cls, page: Page) -> Eyes:
        page.add_init_script(WATCH)
        return cls(page)

    def marks(self) -> list[Mark]:
        # Whatever was just done is on the screen after two animation frames.
        shown: list[dict[str, Any]] = self._page.evaluate(
            "() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => "
            "done(window.shownOnScreen()))))"
        )
        return [Mark(**mark) for mark in shown]

    def proposals(self) -> list[Mark]:
        """Dashed boxes of people who are proposed, one for every view they are seen in."""
        return [
            mark for mark in self.marks() if mark.text is None and mark.dashed and mark.colour == PROPOSED
        ]

    def words(self) -> list[str]:
        """What speaks for the proposal under the pointer."""
        return [mark.text for mark in self.marks() if mark.text and mark.colour == PROPOSED]

    def people(self) -> dict[int, list[Mark]]:
        """Boxes of marked people by the number that stands above them."""
        marks = self.marks()
        boxes = [mark for mark in marks if mark.text is None and mark.colour != PROPOSED]
        found: dict[int, list[Mark]] = {}
        for label in marks:
            if label.text and label.text.isdigit():
                mine = [box for box in boxes if _is_above(label, box)]
                found.setdefault(int(label.text), []).extend(mine[:1])
        return found


def _is_above(label: Mark, box: Mark) -> bool:
    beside = abs(label.x - (box.x + box.width / 2))
    return label.view == box.view and beside < 1.5 and -2 < box.y - label.y < LABEL
