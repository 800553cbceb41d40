const IDLE = 30_000; // ms without a key, click or movement, after which an annotator is taken to be away

/** Active seconds per frame: time between two signs of life counts when they are close enough. */
export class Activity {
  constructor(now = () => performance.now()) {
    this._now = now;
    this._last = now();
    this._milliseconds = new Map();
  }

  /** A sign of life while `frame` was open. */
  note(frame) {
    const now = this._now();
    const passed = now - this._last;
    if (passed < IDLE) this._milliseconds.set(frame, (this._milliseconds.get(frame) ?? 0) + passed);
    this._last = now;
  }

  /** Seconds since the last take. */
  take(frame) {
    const seconds = (this._milliseconds.get(frame) ?? 0) / 1000;
    this._milliseconds.delete(frame);
    return Math.round(seconds * 10) / 10;
  }
}
