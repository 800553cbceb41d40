import { Emitter } from "../../base/emitter.js";
import { gettext } from "../../base/messages.js";
import { keyFor } from "../keys/keys.js";

/**
 * Clicks that mean the top of a head, for people whose feet nobody sees. The place is where the ray through the
 * pixel is as high above the ground as the person is tall. Emits `change` {on}.
 */
export class Heads extends Emitter {
  constructor({ scene, notices }) {
    super();
    Object.assign(this, { _scene: scene, _notices: notices, active: false });
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

  /** Why no head can be clicked on in a view, or null. */
  refusal(pane) {
    if (!this.active || !pane.view.byTable) return null;
    const words = { view: pane.view.title, key: keyFor("heads") };
    return gettext(
      "This page does not know the lens of {view}, so heads mean no place there. {key} means the feet again",
      words,
    );
  }

  /** Metres above the ground of what is clicked on. @param {object|null} person null: somebody new */
  height(pane, person) {
    if (!this.active || pane.view.index === null) return 0;
    return person ? this._scene.cylinderOf(person).height : this._scene.cylinder.height;
  }

  /** The ground point under what is clicked on, or null. `at` in CSS pixels of the pane. */
  ground(pane, at, person) {
    return pane.view.ground(pane.transform.toSource(at.x, at.y), this.height(pane, person));
  }

  /** What is clicked on: a pixel of the view's picture, and how high above the ground it is. */
  pixel(pane, at, person) {
    const { x, y } = pane.transform.toSource(at.x, at.y);
    return { x, y, z: this.height(pane, person) };
  }
}
