import { Emitter } from "../base/emitter.js";

/**
 * What a pointer over the panes can mean. Nothing happens unless a page says what: whoever shows people without
 * letting anybody change them says only what it needs.
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

  /** A click on the ground. */
  place(pane, at, event) {}

  /** A click on somebody. @param {number} person */
  select(person) {}

  /** A right click, or a long press. */
  moveHere(pane, at, event) {}

  /** A click with Alt or Ctrl. */
  sight(pane, at, event) {}

  /** A double click. */
  enlarge(pane, event) {}

  /** @param {object|null} over who is under the pointer */
  hover(pane, at, over) {}

  leave() {}

  /** @param {"foot"|"top"} part @returns {boolean} whether they can be dragged; otherwise the picture is */
  beginDrag(pane, at, person, part, event) {
    return false;
  }

  drag(at) {}

  drop() {}

  cancelDrag() {}
}
