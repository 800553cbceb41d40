import { Intents } from "../views/intents.js";

/**
 * @typedef {import("../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../views/pane.js").Pane} Pane
 * @typedef {{x: number, y: number}} XY in units of a pane
 * @typedef {{pane: Pane, time: number, selection: number|null}} Placed by the last click; `selection`: before it
 *
 * @typedef {object} Parts
 * @property {import("../truth/store.js").Store} store
 * @property {import("../truth/history.js").History} history
 * @property {import("./placing/heads.js").Heads} heads
 * @property {import("./placing/ghost.js").Ghost} ghost
 * @property {import("./placing/moving.js").Moving} moving
 * @property {import("./placing/dragging.js").Dragging} dragging
 * @property {(pane: Pane) => void} enlarge makes a view large, or all alike again
 */

const DOUBLE = 1000; // ms; the longest double click that systems offer is shorter

/** What the pointer means while people are annotated. Emits `moved` when a right click has put the selected person where it is. */
export class AnnotatingIntents extends Intents {
  /** @param {Parts} parts */
  constructor({ store, history, heads, ghost, moving, dragging, enlarge }) {
    super();
    this._store = store;
    this._history = history;
    this._heads = heads;
    this._ghost = ghost;
    this._moving = moving;
    this._dragging = dragging;
    this._enlarge = enlarge;
    /** @type {Placed|null} */
    this._placed = null;
  }

  /** @override */
  get pointsThrough() {
    return this._heads.active;
  }

  /** @override */
  get takesHold() {
    return true;
  }

  /** @override @param {Pane} pane @param {XY} at @param {MouseEvent} event */
  place(pane, at, event) {
    const { selection } = this._store;
    this._placed = this._moving.place(pane, at, event) ? { pane, time: event.timeStamp, selection } : null;
  }

  /**
   * A view was clicked twice: whom the first click has placed is taken back.
   * @override @param {Pane} pane @param {MouseEvent} event
   */
  enlarge(pane, event) {
    const placed = this._placed;
    if (placed?.pane === pane && event.timeStamp - placed.time < DOUBLE) {
      this._history.undo();
      this._store.select(placed.selection);
    }
    this._placed = null;
    this._enlarge(pane);
  }

  /** @override @param {Pane} pane @param {XY} at @param {MouseEvent} event */
  moveHere(pane, at, event) {
    if (this._moving.moveHere(pane, at, event)) this.emit("moved");
  }

  /** @override @param {Pane} pane @param {XY} at @param {MouseEvent} event */
  sight(pane, at, event) {
    this._moving.sight(pane, at, event);
  }

  /** @override @param {Pane} pane @param {XY} at @param {Annotation|null} over who is under the pointer */
  hover(pane, at, over) {
    this._ghost.hover(pane, at, over);
  }

  /** @override */
  leave() {
    this._ghost.hide();
  }

  /**
   * @override
   * @param {Pane} pane @param {XY} at @param {Annotation} person @param {"foot"|"top"} part @param {MouseEvent} event
   */
  beginDrag(pane, at, person, part, event) {
    this._ghost.hide();
    return this._dragging.begin(pane, at, person, part, event);
  }

  /** @override @param {XY} at */
  drag(at) {
    this._dragging.move(at);
  }

  /** @override */
  drop() {
    this._dragging.drop();
  }

  /** @override */
  cancelDrag() {
    this._dragging.cancel();
  }

  /** @override @param {number} person */
  select(person) {
    this._ghost.hide();
    this._store.select(person);
  }
}
