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
 */
export class Dragging {
  constructor({ scene, store, panes, guard, moving, sizes }) {
    Object.assign(this, { _scene: scene, _store: store, _panes: panes, _guard: guard, _moving: moving, _sizes: sizes });
    this._drag = null; // {pane, part, person, offset, at, words}
    panes.addExtra((pane) => this._items(pane));
    store.on(
      "change",
      () => this._drag && store.person(this._drag.person.person) !== this._drag.person && this.cancel(),
    );
    store.on("frame", () => this.cancel());
  }

  get active() {
    return this._drag !== null;
  }

  /** @param {"foot"|"top"} part @returns {boolean} whether the person can be dragged */
  begin(pane, at, person, part, event) {
    if (this._store.person(person.person) !== person || this._guard.refused(event)) return false;
    if (part === "top" && this._sizes.refused(event)) return false;
    this._store.select(person.person);
    const from = pane.transform.toSource(at.x, at.y);
    const held = part === "top" ? { x: from.x, y: pane.view.box(person).ymin } : pane.view.foot(person);
    this._drag = { pane, part, person, offset: { x: held.x - from.x, y: held.y - from.y }, at, words: [] };
    return true;
  }

  /** The pointer is at `at` now. */
  move(at) {
    const drag = this._drag;
    if (!drag) return;
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

  _stretch(drag, { y }) {
    const height = heightReaching(this._scene, drag.pane.view, drag.person, y);
    drag.words = [gettext("{height} m tall", { height: height.toFixed(2) })];
    this._panes.showPreview(changed(drag.person, { height }));
  }

  /** Above the horizon the person stays where the ray last met the ground. */
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

  _remark({ position, person }, ground) {
    if (insideBy(this._scene.grid, ground) < 0) return gettext("the ground area ends here");
    const wanted = this._scene.positionAt(ground);
    const occupant = wanted !== position && wanted !== null && this._store.occupant(wanted, person);
    return occupant ? gettext("beside person {person}, who stands there", { person: occupant.person }) : null;
  }

  _items(pane) {
    if (!this._drag?.words.length || pane !== this._drag.pane) return [];
    const { at, words } = this._drag;
    return [readoutItem("drag-readout", pane.room, at, words, words.length > 1 ? YELLOW : CYAN)];
  }
}
