import { Intents } from "../views/intents.js";

const DOUBLE = 1000; // ms; the longest double click that systems offer is shorter

/** What the pointer means while people are annotated. Emits `moved` when a right click has put the selected person where it is. */
export class AnnotatingIntents extends Intents {
  /** @param {{enlarge: (pane: object) => void}} parts `enlarge` makes a view large, or all alike again */
  constructor({ store, history, heads, ghost, moving, dragging, enlarge }) {
    super();
    Object.assign(this, {
      _store: store,
      _history: history,
      _heads: heads,
      _ghost: ghost,
      _moving: moving,
      _dragging: dragging,
      _enlarge: enlarge,
    });
    this._placed = null; // by the last click: {pane, time, selection before}
  }

  get pointsThrough() {
    return this._heads.active;
  }

  get takesHold() {
    return true;
  }

  place(pane, at, event) {
    const { selection } = this._store;
    this._placed = this._moving.place(pane, at, event) ? { pane, time: event.timeStamp, selection } : null;
  }

  /** A view was clicked twice: whom the first click has placed is taken back. */
  enlarge(pane, event) {
    if (this._placed?.pane === pane && event.timeStamp - this._placed.time < DOUBLE) {
      this._history.undo();
      this._store.select(this._placed.selection);
    }
    this._placed = null;
    this._enlarge(pane);
  }

  moveHere(pane, at, event) {
    if (this._moving.moveHere(pane, at, event)) this.emit("moved");
  }

  sight(pane, at, event) {
    this._moving.sight(pane, at, event);
  }

  hover(pane, at, over) {
    this._ghost.hover(pane, at, over);
  }

  leave() {
    this._ghost.hide();
  }

  beginDrag(pane, at, person, part, event) {
    this._ghost.hide();
    return this._dragging.begin(pane, at, person, part, event);
  }

  drag(at) {
    this._dragging.move(at);
  }

  drop() {
    this._dragging.drop();
  }

  cancelDrag() {
    this._dragging.cancel();
  }

  select(person) {
    this._ghost.hide();
    this._store.select(person);
  }
}
