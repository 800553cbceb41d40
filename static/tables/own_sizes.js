import { Emitter } from "../base/emitter.js";

const TOGETHER = 30; // ms in which people are gathered before the server is asked
const MOST = 500; // people in one question
const AGAIN = 5000; // ms until a question that was not answered is asked again

/**
 * Boxes of people of their own size in views whose model only the server knows: asked for many at once, remembered
 * for ever. Emits `change` when some have arrived.
 * @typedef {import("../base/answers.js").Sized} Sized
 * @typedef {import("../base/answers.js").BoxesByCamera} BoxesByCamera
 * @extends {Emitter<{change: void}>}
 */
export class OwnSizes extends Emitter {
  /** @param {Pick<import("../base/api.js").Api, "rectangles">} api */
  constructor(api) {
    super();
    this._api = api;
    /** @type {Map<string, BoxesByCamera|null>} null: asked for */
    this._known = new Map();
    /** @type {Map<string, Sized>} */
    this._waiting = new Map();
    /** @type {number|null} */
    this._timer = null;
  }

  /**
   * Null where not visible, and until the server has answered.
   * @param {number} index of the camera @param {Sized} person
   * @returns {import("../geometry/rectangle.js").Rectangle|null}
   */
  rectangle(index, { position, height, radius }) {
    const key = `${position} ${height} ${radius}`;
    if (!this._known.has(key)) {
      this._known.set(key, null);
      this._waiting.set(key, { position, height, radius });
      this._timer ??= setTimeout(() => this._ask(), TOGETHER);
    }
    const box = this._known.get(key)?.[index];
    return box ? { xmin: box[0], ymin: box[1], xmax: box[2], ymax: box[3] } : null;
  }

  async _ask() {
    this._timer = null;
    const asked = [...this._waiting].slice(0, MOST);
    for (const [key] of asked) this._waiting.delete(key);
    try {
      const { rectangles } = await this._api.rectangles(asked.map(([, person]) => person));
      asked.forEach(([key], place) => this._known.set(key, rectangles[place]));
      this.emit("change");
    } catch (error) {
      console.warn("boxes did not arrive", error);
      for (const [key, person] of asked) this._waiting.set(key, person);
      this._timer ??= setTimeout(() => this._ask(), AGAIN);
    }
    if (this._waiting.size) this._timer ??= setTimeout(() => this._ask(), TOGETHER);
  }
}
