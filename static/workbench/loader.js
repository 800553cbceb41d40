/**
 * Brings frames from the server into the saver and the store: a batch at once, a long layer in pieces around
 * the frame that is opened.
 */
const PIECE = 20;

export class Loader {
  constructor({ api, scene, saver, store }) {
    Object.assign(this, { _api: api, _scene: scene, _saver: saver, _store: store });
  }

  /** Everything needed to start at `number`. */
  async start(number) {
    if (this._scene.mode !== "layer") this._install((await this._api.frames()).frames);
    else await this.load(number, false);
  }

  /** Make sure a frame is there; `again`: take the server's newest state even so. */
  async load(number, again) {
    if (again) return this._saver.install(await this._api.frame(number));
    if (this._store.frame(number).loaded) return;
    const index = this._store.numbers.indexOf(number);
    const from = this._store.numbers[Math.max(0, index - 2)];
    this._install((await this._api.frames(`?from=${from}&count=${PIECE}`)).frames);
  }

  _install(frames) {
    for (const state of frames) {
      if (!this._store.frame(state.number).loaded) this._saver.install(state);
    }
  }
}
