/**
 * Brings frames from the server into the saver and the store: a batch at once, a long layer in pieces around
 * the frame that is opened.
 */
const PIECE = 20;

export class Loader {
  constructor({ api, scene, store }) {
    Object.assign(this, { _api: api, _scene: scene, _store: store, _saver: null });
  }

  /** The states needed to start at `number`; can be asked for before there is a saver. */
  async start(number) {
    return (await this._api.frames(this._scene.mode === "layer" ? this._around(number) : "")).frames;
  }

  connect(saver, states) {
    this._saver = saver;
    this._install(states);
  }

  /** Make sure a frame is there; `again`: take the server's newest state even so, and keep what is edited meanwhile. */
  async load(number, again) {
    if (again) this._saver.refresh(await this._api.frame(number));
    else if (!this._store.frame(number).loaded) this._install((await this._api.frames(this._around(number))).frames);
  }

  /** Make sure all these frames are there. */
  async loadAll(numbers = this._store.numbers) {
    for (const number of numbers) await this.load(number, false);
  }

  /** A little before the frame too: it is where one goes back to, and where people are carried over from. */
  _around(number) {
    const { numbers } = this._store;
    return `?from=${numbers[Math.max(0, numbers.indexOf(number) - 2)]}&count=${PIECE}`;
  }

  _install(states) {
    for (const state of states) {
      if (!this._store.frame(state.number).loaded) this._saver.install(state);
    }
  }
}
