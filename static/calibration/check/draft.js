/**
 * @typedef {{[camera: string]: number[]}} Clicks pixels x, y by the camera's name
 * @typedef {{clicks: Clicks, what: string}} Step
 */

/** Clicks on a thing that is not kept yet, each of which can be taken back and done again. */
export class Draft {
  constructor() {
    /** @type {Clicks} */
    this.clicks = {};
    /** @type {Step[]} what was before each step, and what the step was */
    this._past = [];
    /** @type {Step[]} */
    this._ahead = [];
  }

  /** Begin anew, with nothing to take back. @param {Clicks} [clicks] */
  forget(clicks = {}) {
    this.clicks = clicks;
    this._past = [];
    this._ahead = [];
  }

  get empty() {
    return Object.keys(this.clicks).length === 0;
  }

  /** What taking back would take back, in words. */
  get undo() {
    return this._past.at(-1)?.what ?? "";
  }

  get redo() {
    return this._ahead.at(-1)?.what ?? "";
  }

  /** @param {string} camera @param {number[]} place @param {string} what moving on by the same step is one step */
  put(camera, place, what) {
    this._step({ ...this.clicks, [camera]: place }, what, what === this.undo && what.startsWith("nudge"));
  }

  /** @param {string} camera */
  remove(camera) {
    if (!(camera in this.clicks)) return;
    const { [camera]: _, ...others } = this.clicks;
    this._step(others, `click in ${camera} taken away`);
  }

  clear() {
    if (!this.empty) this._step({}, "clicks taken away");
  }

  takeBack() {
    this._swap(this._past, this._ahead);
  }

  doAgain() {
    this._swap(this._ahead, this._past);
  }

  /** What was undone before is not to be done again: something else was undone since. */
  forgetAhead() {
    this._ahead = [];
  }

  /** @param {Clicks} clicks @param {string} what @param {boolean} [goesOn] the step before goes on */
  _step(clicks, what, goesOn = false) {
    if (!goesOn) this._past.push({ clicks: this.clicks, what });
    this._ahead = [];
    this.clicks = clicks;
  }

  /** @param {Step[]} from @param {Step[]} to */
  _swap(from, to) {
    const step = from.pop();
    if (!step) return;
    to.push({ clicks: this.clicks, what: step.what });
    this.clicks = step.clicks;
  }
}
