import { Emitter } from "../base/emitter.js";

/**
 * What a pointer over the panes can mean. Nothing happens unless a page says what: whoever shows people without
 * letting anybody change them says only what it needs. Emits `moved` where somebody was moved by it.
 * @typedef {import("./pane.js").Pane} Pane
 * @typedef {import("./pane.js").Person} Person
 * @typedef {import("./regions.js").XY} XY
 * @typedef {"foot"|"top"} Part of a person, to take hold of
 * @extends {Emitter<{moved: void}>}
 */
export class Intents extends Emitter {
  /** Clicks mean what is behind the boxes: nobody is picked, and nobody is taken hold of. */
  get pointsThrough() {
    return false;
  }

  /** Whether people can be dragged at all, and the cursor says so. */
  get takesHold() {
    return false;
  }

  /** A click on the ground. @param {Pane} pane @param {XY} at @param {MouseEvent} event */
  place(pane, at, event) {}

  /** A click on somebody. @param {number} person */
  select(person) {}

  /** A right click, or a long press. @param {Pane} pane @param {XY} at @param {MouseEvent} event */
  moveHere(pane, at, event) {}

  /** A click with Alt or Ctrl. @param {Pane} pane @param {XY} at @param {MouseEvent} event */
  sight(pane, at, event) {}

  /** A double click. @param {Pane} pane @param {MouseEvent} event */
  enlarge(pane, event) {}

  /** @param {Pane} pane @param {XY} at @param {Person|null} over who is under the pointer */
  hover(pane, at, over) {}

  leave() {}

  /**
   * @param {Pane} pane @param {XY} at @param {Person} person @param {Part} part @param {MouseEvent} event
   * @returns {boolean} whether they can be dragged; otherwise the picture is
   */
  beginDrag(pane, at, person, part, event) {
    return false;
  }

  /** @param {XY} at */
  drag(at) {}

  drop() {}

  cancelDrag() {}
}
