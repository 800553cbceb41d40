/**
 * Brings frames from the server into the saver and the store: a batch at once, a long layer in pieces around
 * the frame that is opened.
 * @typedef {import("../base/answers.js").FrameAnswer} FrameAnswer
 */
const PIECE = 20;

export class Loader {
  /**
   * @param {{api: import("../base/api.js").Api, scene: import("../truth/scene.js").Scene,
   * store: import("../truth/store.js").Store}} parts
   */
  constructor({ api, scene, store }) {
    this._api = api;
    this._scene = scene;
    this._store = store;
    /** @type {import("./saver.js").Saver|null} */
    this._saver = null;
  }

  /**
   * The states needed to start at `number`; can be asked for before there is a saver.
   * @param {number} number
   */
  async start(number) {
    return (await this._api.frames(this._scene.mode === "layer" ? this._around(number) : "")).frames;
  }

  /** @param {import("./saver.js").Saver} saver @param {FrameAnswer[]} states */
  connect(saver, states) {
    this._saver = saver;
    this._install(states);
  }

  /**
   * Make sure a frame is there; `again`: take the server's newest state even so, and keep what is edited meanwhile.
   * @param {number} number @param {boolean} again
   */
  async load(number, again) {
    if (again) this._known.refresh(await this._api.frame(number));
    else if (!this._store.frame(number).loaded) this._install((await this._api.frames(this._around(number))).frames);
  }

  /**
   * Make sure all these frames are there.
   * @param {number[]} [numbers]
   */
  async loadAll(numbers = this._store.numbers) {
    for (const number of numbers) await this.load(number, false);
  }

  get _known() {
    if (!this._saver) throw new Error("frames are loaded before there is a saver");
    return this._saver;
  }

  /**
   * A little before the frame too: it is where one goes back to, and where people are carried over from.
   * @param {number} number
   */
  _around(number) {
    const { numbers } = this._store;
    return `?from=${numbers[Math.max(0, numbers.indexOf(number) - 2)]}&count=${PIECE}`;
  }

  /** @param {FrameAnswer[]} states */
  _install(states) {
    for (const state of states) {
      if (!this._store.frame(state.number).loaded) this._known.install(state);
    }
  }
}
