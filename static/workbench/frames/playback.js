import { Emitter } from "../../base/emitter.js";

/**
 * Plays through the frames, only looking. Never skips a frame: it waits for pictures. Emits `change`.
 * @extends {Emitter<{change: void}>}
 */
export class Playback extends Emitter {
  /**
   * @param {object} parts
   * @param {import("../../truth/scene.js").Scene} parts.scene
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {import("../../views/images.js").Images} parts.images
   * @param {import("./navigation.js").Navigation} parts.navigation
   * @param {import("../settings.js").Settings} parts.settings
   */
  constructor({ scene, store, images, navigation, settings }) {
    super();
    this.scene = scene;
    this.store = store;
    this.images = images;
    this.navigation = navigation;
    this.settings = settings;
    /** @type {number|null} */
    this._request = null;
    this._due = 0;
    // Whoever clicks or edits wants to work on what is shown now.
    /** @param {PointerEvent} event */
    this._onPointer = ({ target }) => {
      if (!(target instanceof Element && target.closest("[data-action=play]"))) this.stop();
    };
    store.on("change", ({ source }) => source === "edit" && this.stop());
  }

  get playing() {
    return this._request !== null;
  }

  toggle() {
    if (this.playing) this.stop();
    else this.start();
  }

  /** From here, or from the first frame when this is the last. */
  start() {
    const { store, navigation } = this;
    if (store.numbers.length < 2) return;
    navigation.lookAhead(true);
    if (store.neighbour(1) === undefined) this._show(store.numbers[0]);
    this._due = performance.now() + this._interval;
    document.addEventListener("pointerdown", this._onPointer, { capture: true });
    this._ask();
    this.emit("change");
  }

  /** Where it stops one can work: the frame is opened as if one had gone there. */
  stop() {
    if (this._request === null) return;
    cancelAnimationFrame(this._request);
    this._request = null;
    document.removeEventListener("pointerdown", this._onPointer, { capture: true });
    this.navigation.lookAhead(false);
    this.emit("change");
    this.navigation.jump(this.store.current);
  }

  get _interval() {
    return (1000 * this.scene.dataset.seconds_per_frame) / this.settings.get("playSpeed");
  }

  _ask() {
    this._request = requestAnimationFrame((now) => this._tick(now));
  }

  /** @param {number} now ms */
  _tick(now) {
    const next = this.store.neighbour(1);
    if (next === undefined) return this.stop();
    if (now >= this._due && this._ready(next)) {
      // Keep the beat; after a wait for pictures, or in a hidden tab, start a new one.
      this._due = now - this._due < this._interval ? this._due + this._interval : now + this._interval;
      this._show(next);
    }
    this._ask();
  }

  /**
   * A frame that cannot be loaded ends the film where it is.
   * @param {number} number
   */
  async _show(number) {
    if (!(await this.navigation.look(number))) this.stop();
  }

  /**
   * A picture that failed for good does not hold up the others.
   * @param {number} number
   */
  _ready(number) {
    return this.scene.cameras.every(({ index }) => {
      const { bitmap, status } = this.images.get(number, index, "light");
      return bitmap !== null || status === "error";
    });
  }
}
