/**
 * @typedef {"left"|"right"|"up"|"down"} Arrow
 * @typedef {{columns: number, rows: number}} Step
 * @typedef {Record<Arrow, Step>} Steps
 *
 * A held arrow key. It keeps the direction it began with, also where the view would by now lay the keys
 * differently, and every repeat is at least one position: the first 60 (2 s, 1.5 m) exactly one.
 */
/** @type {[after: number, pace: number][]} */
const PACES = [
  [120, 4],
  [60, 2],
]; // repeats after which so many positions are gone at once

export class KeyRepeat {
  /** @param {import("../settings.js").Settings} settings */
  constructor(settings) {
    this._settings = settings;
    /** @type {Arrow|null} */
    this._name = null;
    /** @type {Steps|null} what every arrow key does as long as one is held */
    this.steps = null;
    this._repeats = 0;
    window.addEventListener("keyup", () => this.release());
    window.addEventListener("blur", () => this.release());
  }

  /**
   * @param {Arrow} name @param {KeyboardEvent|null} event @param {() => Steps} decide what the keys do now
   * @returns {Steps}
   */
  press(name, event, decide) {
    if (event?.repeat && this._name === name && this.steps) {
      this._repeats += 1;
    } else {
      this._name = name;
      this._repeats = 0;
      this.steps = decide();
    }
    return this.steps;
  }

  get pace() {
    return this._settings.get("heldKeysSpeedUp") ? paceAfter(this._repeats) : 1;
  }

  release() {
    this._name = null;
    this.steps = null;
    this._repeats = 0;
  }
}

/** @param {number} repeats */
export function paceAfter(repeats) {
  return PACES.find(([after]) => repeats > after)?.[1] ?? 1;
}
