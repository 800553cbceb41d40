import { Emitter } from "../../base/emitter.js";
import { gettext } from "../../base/messages.js";
import { keyFor } from "../keys/keys.js";

/**
 * Clicks that mean the top of a head, for people whose feet nobody sees. The place is where the ray through the
 * pixel is as high above the ground as the person is tall. Emits `change` {on}.
 * @typedef {import("../../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../../truth/ground_point.js").XY} XY
 * @typedef {import("../../truth/scene.js").Scene} Scene
 * @typedef {import("../../views/pane.js").Pane} Pane
 * @typedef {XY & {z: number}} Pixel of a view's picture, and how many metres above the ground is what it shows
 * @extends {Emitter<{change: {on: boolean}}>}
 */
export class Heads extends Emitter {
  /** @param {{scene: Scene, notices: {say: (text: string) => void}}} parts */
  constructor({ scene, notices }) {
    super();
    this._scene = scene;
    this._notices = notices;
    this.active = false;
  }

  toggle(on = !this.active) {
    if (on === this.active) return;
    this.active = on;
    this.emit("change", { on });
    const words = on
      ? gettext("Clicks mean the top of the head now; {key} means the feet again", { key: keyFor("heads") })
      : gettext("Clicks mean the feet again");
    this._notices.say(words);
  }

  /**
   * Why no head can be clicked on in a view, or null.
   * @param {Pane} pane
   */
  refusal(pane) {
    if (!this.active || !pane.view.byTable) return null;
    const words = { view: pane.view.title, key: keyFor("heads") };
    return gettext(
      "This page does not know the lens of {view}, so heads mean no place there. {key} means the feet again",
      words,
    );
  }

  /**
   * Metres above the ground of what is clicked on.
   * @param {Pane} pane @param {Annotation|null} person null: somebody new @returns {number}
   */
  height(pane, person) {
    if (!this.active || pane.view.index === null) return 0;
    return person ? this._scene.cylinderOf(person).height : this._scene.cylinder.height;
  }

  /**
   * The ground point under what is clicked on, or null.
   * @param {Pane} pane @param {XY} at CSS pixels of the pane @param {Annotation|null} person @returns {XY|null}
   */
  ground(pane, at, person) {
    return pane.view.ground(clicked(pane, at), this.height(pane, person));
  }

  /**
   * What is clicked on.
   * @param {Pane} pane @param {XY} at CSS pixels of the pane @param {Annotation|null} person @returns {Pixel}
   */
  pixel(pane, at, person) {
    const { x, y } = clicked(pane, at);
    return { x, y, z: this.height(pane, person) };
  }
}

/** @param {Pane} pane @param {XY} at @returns {XY} */
function clicked({ transform }, { x, y }) {
  if (!transform) throw new TypeError("a pane without room cannot be clicked on");
  return transform.toSource(x, y);
}
