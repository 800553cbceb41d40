import { videoTime } from "./clocks.js";

const LENGTH = 2; // seconds that are fetched together
export const RATE = 10; // pictures a second while playing

/**
 * @typedef {import("./store.js").Store} Store
 * @typedef {import("./store.js").Clock} Clock
 * @typedef {import("./pictures.js").Pictures} Pictures
 * @typedef {import("./pictures.js").Strip} Strip
 * @typedef {import("./pictures.js").Shown} Shown
 * @typedef {{strip: Strip, first: number}} Part `first`: number of its first picture in the piece
 * @typedef {{parts: Map<string, Part|null>, ready: boolean}} Piece by file
 */

/**
 * Plays all videos in step, at real speed while the server keeps up: where pictures of one are late, all wait.
 */
export class Player {
  /** @param {Store} store @param {Pictures} pictures @param {() => Clock[]} shown the videos on the screen */
  constructor(store, pictures, shown) {
    this._store = store;
    this._pictures = pictures;
    this._shown = shown;
    this.playing = false;
    this.waiting = false; // for the server
    this.late = 0; // seconds it was waited in all since it began
    /** @type {Map<number, Piece>} */
    this._pieces = new Map();
    this._last = 0;
    this._position = 0;
  }

  start() {
    const { from, until } = this._store.shared;
    const inside = this._store.time >= from && this._store.time < until - 0.5;
    if (until > from && !inside) this._store.goTo(from);
    this._position = this._store.time;
    this._pieces.clear();
    this.playing = true;
    this.late = 0;
    this._last = performance.now();
    requestAnimationFrame((now) => this._frame(now));
  }

  stop() {
    this.playing = false;
    this.waiting = false;
    this._pieces.clear();
    this._store.goTo(this._store.time);
  }

  /** What is fetched is of other clocks. */
  forget() {
    this._pieces.clear();
    this._position = this._store.time;
  }

  /** The picture of a video now; null where it has none. @param {Clock} clock @returns {Shown|null} */
  picture(clock) {
    const tick = Math.round(this._store.time * RATE);
    const piece = Math.floor(tick / (LENGTH * RATE));
    const part = this._pieces.get(piece)?.parts.get(clock.file);
    const row = part ? tick - piece * LENGTH * RATE - part.first : -1;
    return part && row >= 0 && row < part.strip.times.length ? { strip: part.strip, row } : null;
  }

  /** @param {number} now */
  _frame(now) {
    if (!this.playing) return;
    const passed = (now - this._last) / 1000;
    this._last = now;
    const next = this._position + passed;
    const number = Math.floor(Math.floor(next * RATE) / (LENGTH * RATE));
    this.waiting = !this._piece(number).ready;
    this._piece(number + 1);
    if (this.waiting) this.late += passed;
    else this._position = next;
    this._drop(number);
    if (this._position >= this._end()) return this.stop();
    const time = Math.floor(this._position * RATE) / RATE;
    if (time !== this._store.time || this.waiting) this._store.goTo(time);
    requestAnimationFrame((later) => this._frame(later));
  }

  _end() {
    const { from, until } = this._store.shared;
    return until > from ? until : this._store.bounds.until;
  }

  /** @param {number} number */
  _piece(number) {
    const found = this._pieces.get(number);
    if (found) return found;
    /** @type {Piece} */
    const piece = { parts: new Map(), ready: false };
    this._pieces.set(number, piece);
    const parts = this._shown().map(async (clock) => {
      piece.parts.set(clock.file, await this._part(clock, number).catch(() => null));
    });
    void Promise.all(parts).then(() => {
      piece.ready = true;
    });
    return piece;
  }

  /** @param {Clock} clock @param {number} number @returns {Promise<Part|null>} */
  async _part(clock, number) {
    const video = this._store.video(clock);
    const times = Array.from({ length: LENGTH * RATE }, (_, at) => videoTime(clock, number * LENGTH + at / RATE));
    const end = video.start + video.duration - video.interval / 2;
    const inside = times.flatMap((time, at) => (time >= video.start - video.interval / 2 && time <= end ? [at] : []));
    if (!inside.length) return null;
    const at = Math.max(times[inside[0]], 0);
    return {
      strip: await this._pictures.strip(this._store.number(clock), at, 1 / RATE, inside.length),
      first: inside[0],
    };
  }

  /** @param {number} number */
  _drop(number) {
    for (const [old, { parts }] of this._pieces) {
      if (old === number || old === number + 1) continue;
      for (const part of parts.values()) part?.strip.bitmap.close();
      this._pieces.delete(old);
    }
  }
}
