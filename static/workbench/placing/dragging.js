import { gettext } from "../../base/messages.js";
import { changed } from "../../truth/annotation.js";
import { insideBy } from "../../truth/ground_point.js";
import { readoutItem } from "../../views/hints_on_ground.js";
import { CYAN, YELLOW } from "../../views/styles.js";
import { landing } from "./moving.js";
import { heightReaching } from "./sizes.js";

/**
 * Dragging a person by foot, box or dot, or the top of the selected box. All views show at once where the
 * person would be; the truth changes when the pointer lets go, in one step to undo. Escape leaves it as it was.
 * @typedef {import("../../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../../truth/ground_point.js").XY} XY
 * @typedef {import("../../views/pane.js").Pane} Pane
 * @typedef {"foot"|"top"} Part what is taken hold of; the box counts as the foot
 * @typedef {object} Drag
 * @property {Pane} pane
 * @property {Part} part
 * @property {Annotation} person as they were when the drag began
 * @property {XY} offset from the pointer to what is held, pixels of the view's picture
 * @property {XY} at the pointer, CSS pixels of the pane
 * @property {string[]} words
 */
export class Dragging {
  /**
   * @param {object} parts
   * @param {import("../../truth/scene.js").Scene} parts.scene
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {import("../../views/panes.js").Panes} parts.panes
   * @param {import("./guard.js").Guard} parts.guard
   * @param {import("./moving.js").Moving} parts.moving
   * @param {import("./sizes.js").Sizes} parts.sizes
   */
  constructor({ scene, store, panes, guard, moving, sizes }) {
    this._scene = scene;
    this._store = store;
    this._panes = panes;
    this._guard = guard;
    this._moving = moving;
    this._sizes = sizes;
    /** @type {Drag|null} */
    this._drag = null;
    panes.addExtra(/** @param {Pane} pane */ (pane) => this._items(pane));
    store.on(
      "change",
      () => this._drag && store.person(this._drag.person.person) !== this._drag.person && this.cancel(),
    );
    store.on("frame", () => this.cancel());
  }

  get active() {
    return this._drag !== null;
  }

  /**
   * @param {Pane} pane @param {XY} at @param {Annotation} person @param {Part} part
   * @param {import("./guard.js").Where} event where a refusal is said
   * @returns {boolean} whether the person can be dragged
   */
  begin(pane, at, person, part, event) {
    if (this._store.person(person.person) !== person || this._guard.refused(event)) return false;
    if (part === "top" && this._sizes.refused(event)) return false;
    this._store.select(person.person);
    const [from, held] = [pane.transform?.toSource(at.x, at.y), heldPoint(pane, person, part)];
    if (!from || !held) return false;
    this._drag = { pane, part, person, offset: { x: (held.x ?? from.x) - from.x, y: held.y - from.y }, at, words: [] };
    return true;
  }

  /**
   * The pointer is at `at` now.
   * @param {XY} at
   */
  move(at) {
    const drag = this._drag;
    if (!drag?.pane.transform) return;
    const { x, y } = drag.pane.transform.toSource(at.x, at.y);
    const held = { x: x + drag.offset.x, y: y + drag.offset.y };
    drag.at = at;
    if (drag.part === "top") this._stretch(drag, held);
    else this._carry(drag, held);
    this._panes.markPeople();
  }

  drop() {
    const drag = this._drag;
    const preview = this._panes.preview;
    this.cancel();
    if (!drag || !preview) return;
    if (drag.part === "top") this._sizes.set(drag.person, { height: preview.height });
    else this._moving.moveTo(drag.person, preview.position, null);
  }

  /** @returns {boolean} whether there was anything to cancel */
  cancel() {
    if (!this._drag) return false;
    this._drag = null;
    this._panes.showPreview(null);
    this._panes.markPeople();
    return true;
  }

  /** @param {Drag} drag @param {XY} top */
  _stretch(drag, { y }) {
    const height = heightReaching(this._scene, drag.pane.view, drag.person, y);
    drag.words = [gettext("{height} m tall", { height: height.toFixed(2) })];
    this._panes.showPreview(changed(drag.person, { height }));
  }

  /**
   * Above the horizon the person stays where the ray last met the ground.
   * @param {Drag} drag @param {XY} foot
   */
  _carry(drag, foot) {
    const ground = drag.pane.view.ground(foot);
    if (!ground) {
      drag.words = [drag.pane.view.byTable ? gettext("no feet in the ground area") : gettext("above the horizon")];
      return;
    }
    const preview = landing(this._scene, this._store, drag.person, ground);
    this._panes.showPreview(preview);
    const { x, y } = this._scene.metres(preview.position);
    drag.words = [gettext("x {x}  y {y} m", { x: x.toFixed(3), y: y.toFixed(3) })];
    const remark = this._remark(preview, ground);
    if (remark) drag.words.push(remark);
  }

  /** @param {Annotation} preview @param {XY} ground */
  _remark({ position, person }, ground) {
    if (insideBy(this._scene.grid, ground) < 0) return gettext("the ground area ends here");
    const wanted = this._scene.positionAt(ground);
    const occupant = wanted === position || wanted === null ? null : this._store.occupant(wanted, person);
    return occupant ? gettext("beside person {person}, who stands there", { person: occupant.person }) : null;
  }

  /** @param {Pane} pane */
  _items(pane) {
    if (!this._drag?.words.length || pane !== this._drag.pane) return [];
    const { at, words } = this._drag;
    return [readoutItem("drag-readout", pane.room, at, words, words.length > 1 ? YELLOW : CYAN)];
  }
}

/**
 * What is held, in pixels of the view's picture: the foot, or anywhere along the top of the box.
 * @param {Pane} pane @param {Annotation} person @param {Part} part @returns {{x: number|null, y: number}|null}
 */
function heldPoint({ view }, person, part) {
  if (part === "foot") return view.foot(person);
  const box = view.box(person);
  return box && { x: null, y: box.ymin };
}
