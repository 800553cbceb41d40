/** Two fingers on one pane: what is between them grows and moves with them. */
export class Fingers {
  constructor() {
    this._on = new Map(); // pointer id → {pane, x, y}, in CSS pixels of the pane
  }

  /** @returns {boolean} whether there are two of them now */
  down(pane, event) {
    if (event.pointerType !== "touch") return false;
    this._on.set(event.pointerId, { pane, ...pane.local(event) });
    if (this._pair(pane)) pane.element.setPointerCapture(event.pointerId);
    return this._pair(pane) !== null;
  }

  /** @returns {boolean} whether the move was one of two fingers */
  move(pane, event) {
    const pair = this._on.has(event.pointerId) && this._pair(pane);
    if (!pair) return false;
    const [before, distance] = [middle(pair), apart(pair)];
    Object.assign(this._on.get(event.pointerId), pane.local(event));
    const after = middle(pair);
    const zoomed = pane.transform.zoomAt(Math.max(apart(pair), 1) / Math.max(distance, 1), before.x, before.y);
    pane.look(zoomed.moved(after.x - before.x, after.y - before.y));
    return true;
  }

  up(event) {
    this._on.delete(event.pointerId);
  }

  _pair(pane) {
    const here = [...this._on.values()].filter((finger) => finger.pane === pane);
    return here.length === 2 ? here : null;
  }
}

function middle([one, other]) {
  return { x: (one.x + other.x) / 2, y: (one.y + other.y) / 2 };
}

function apart([one, other]) {
  return Math.hypot(one.x - other.x, one.y - other.y);
}
