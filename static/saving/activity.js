const IDLE = 30_000; // ms without a key, click or movement, after which an annotator is taken to be away
const SENT_IN = 100; // ms; what is less waits for the next save

/** Active seconds per frame: time between two signs of life counts when they are close enough. */
export class Activity {
  constructor(now = () => performance.now()) {
    this._now = now;
    this._last = now();
    /** @type {Map<number, number>} by frame */
    this._milliseconds = new Map();
  }

  /**
   * A sign of life while `frame` was open.
   * @param {number} frame
   */
  note(frame) {
    const now = this._now();
    const passed = now - this._last;
    if (passed < IDLE) this._add(frame, passed);
    this._last = now;
  }

  /**
   * Seconds since the last take.
   * @param {number} frame
   */
  take(frame) {
    const tenths = Math.floor(this._of(frame) / SENT_IN);
    this._milliseconds.set(frame, this._of(frame) - tenths * SENT_IN);
    return tenths / 10;
  }

  /**
   * Taken, and not counted by the server: they go with the next save.
   * @param {number} frame @param {number} seconds
   */
  giveBack(frame, seconds) {
    this._add(frame, seconds * 1000);
  }

  /**
   * Seconds nobody has taken yet.
   * @param {number} frame
   */
  waiting(frame) {
    return this._of(frame) / 1000;
  }

  /** @param {number} frame */
  _of(frame) {
    return this._milliseconds.get(frame) ?? 0;
  }

  /** @param {number} frame @param {number} milliseconds */
  _add(frame, milliseconds) {
    this._milliseconds.set(frame, this._of(frame) + milliseconds);
  }
}
