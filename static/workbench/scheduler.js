/** Many changes, one repaint per animation frame: whoever is marked is asked to paint once. */
export class Scheduler {
  constructor() {
    this._waiting = new Set();
    this._frame = null;
  }

  /** @param {{paint: () => void}} painter */
  mark(painter) {
    this._waiting.add(painter);
    this._frame ??= requestAnimationFrame(() => this._run());
  }

  _run() {
    this._frame = null;
    const painters = [...this._waiting];
    this._waiting.clear();
    for (const painter of painters) painter.paint();
  }
}
