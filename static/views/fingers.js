/**
 * Two fingers on one pane: what is between them grows and moves with them.
 * @typedef {import("./pane.js").Pane} Pane
 * @typedef {import("./regions.js").XY} XY
 * @typedef {{pane: Pane} & XY} Finger in units of the pane
 */
export class Fingers {
  constructor() {
    /** @type {Map<number, Finger>} */
    this._on = new Map(); // by the pointer's id
  }

  /**
   * @param {Pane} pane @param {PointerEvent} event
   * @returns {boolean} whether there are two of them now
   */
  down(pane, event) {
    if (event.pointerType !== "touch") return false;
    this._on.set(event.pointerId, { pane, ...pane.local(event) });
    if (this._pair(pane)) pane.element.setPointerCapture(event.pointerId);
    return this._pair(pane) !== null;
  }

  /**
   * @param {Pane} pane @param {PointerEvent} event
   * @returns {boolean} whether the move was one of two fingers
   */
  move(pane, event) {
    const finger = this._on.get(event.pointerId);
    const pair = finger && this._pair(pane);
    if (!pair || !pane.transform) return false;
    const [before, distance] = [middle(pair), apart(pair)];
    Object.assign(finger, pane.local(event));
    const after = middle(pair);
    const zoomed = pane.transform.zoomAt(Math.max(apart(pair), 1) / Math.max(distance, 1), before.x, before.y);
    pane.look(zoomed.moved(after.x - before.x, after.y - before.y));
    return true;
  }

  /** @param {PointerEvent} event */
  up(event) {
    this._on.delete(event.pointerId);
  }

  /** @param {Pane} pane @returns {[Finger, Finger]|null} */
  _pair(pane) {
    const [one, other, ...more] = [...this._on.values()].filter((finger) => finger.pane === pane);
    return one && other && !more.length ? [one, other] : null;
  }
}

/** @param {[XY, XY]} pair @returns {XY} */
function middle([one, other]) {
  return { x: (one.x + other.x) / 2, y: (one.y + other.y) / 2 };
}

/** @param {[XY, XY]} pair */
function apart([one, other]) {
  return Math.hypot(one.x - other.x, one.y - other.y);
}
