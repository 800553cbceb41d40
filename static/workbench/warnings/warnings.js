/**
 * @typedef {import("../../truth/plausibility.js").Warning} Warning
 * @typedef {import("../../truth/plausibility.js").XY} XY
 * @typedef {{number: number, time: number, people: import("../../truth/annotation.js").People}} Moment seconds, and who is where
 */
import { Emitter } from "../../base/emitter.js";
import { findWarnings, inMiddle } from "../../truth/plausibility.js";

const CALM = 250; // ms after the last edit: a held key is not slowed down, and nothing flickers

/**
 * What is physically wrong in the frames that are loaded, apart from what the annotator has looked at and let
 * stand. It only tells; nothing is ever stopped by it. Emits `change`.
 * @extends {Emitter<{change: void}>}
 */
export class Warnings extends Emitter {
  /** @param {Pick<import("../../saving/session.js").Session, "scene"|"store"|"journal">} session */
  constructor({ scene, store, journal }) {
    super();
    this._scene = scene;
    this._store = store;
    this._journal = journal;
    /** @type {Warning[]} */
    this._all = [];
    /** @type {Set<string>} */
    this._dismissed = new Set();
    /** @type {ReturnType<typeof setTimeout>|undefined} */
    this._timer = undefined;
    /** @type {Warning[]} */
    this.list = [];
    store.on("change", () => this._later());
    this._start();
  }

  /**
   * Those of one frame.
   * @param {number} number
   */
  of(number) {
    return this.list.filter(({ frame }) => frame === number);
  }

  get dismissed() {
    return this._all.length - this.list.length;
  }

  /**
   * This case is right as it is.
   * @param {Warning} warning
   */
  dismiss({ key }) {
    this._dismissed.add(key);
    this._keep();
  }

  /** Show all of them again. */
  restore() {
    this._dismissed.clear();
    this._keep();
  }

  async _start() {
    this._dismissed = new Set(await this._journal.readDismissed());
    this._find();
  }

  _keep() {
    this._journal.writeDismissed([...this._dismissed]);
    this._show();
  }

  _later() {
    clearTimeout(this._timer);
    this._timer = setTimeout(() => this._find(), CALM);
  }

  _find() {
    /** @type {import("../../truth/plausibility.js").Ground} */
    const ground = {
      metres: (position) => this._scene.metres(position),
      inMiddle: (point) => inMiddle(point, (one) => this._isSeen(one)),
    };
    this._all = this._pieces().flatMap((frames) => findWarnings(frames, ground));
    this._show();
  }

  _show() {
    const known = new Map(this.list.map((one) => [JSON.stringify(one), one]));
    const open = this._all.filter(({ key }) => !this._dismissed.has(key));
    this.list = open.map((one) => known.get(JSON.stringify(one)) ?? one); // the same stay the same: not painted again
    this.emit("change");
  }

  /** Runs of frames that are loaded: across a gap nothing can be said. */
  _pieces() {
    /** @type {Moment[][]} */
    const pieces = [[]];
    for (const number of this._store.numbers) {
      const { loaded, people } = this._store.frame(number);
      const piece = pieces[pieces.length - 1];
      if (loaded) piece.push({ number, time: this._scene.seconds(number), people });
      else if (piece.length) pieces.push([]);
    }
    return pieces;
  }

  /** @param {XY} point */
  _isSeen(point) {
    if (this._scene.positionAt(point) === null) return false;
    return this._scene.cameras.some(({ width, height }, index) => {
      const pixel = this._scene.toImage(index, point);
      return pixel !== null && pixel.x >= 0 && pixel.y >= 0 && pixel.x < width && pixel.y < height;
    });
  }
}
