import { gettext } from "../../base/messages.js";
import { keyFor } from "../keys/keys.js";

/** Who may be edited, and why not: every refusal is said where the annotator looks. */
export class Guard {
  constructor({ store, saver, panes, notices }) {
    Object.assign(this, { store, saver, panes, notices });
  }

  get editable() {
    return this.saver.readOnly === null;
  }

  /** @param place a pointer event, a place in the window, null for the bottom of the screen; or what answers with one */
  refused(place = null) {
    if (this.editable) return false;
    this.say(place, gettext("Read-only: {reason}", { reason: this.saver.readOnly }));
    return true;
  }

  /** The selected person if it may be edited. */
  selected(place = null) {
    if (this.refused(place)) return null;
    const person = this.store.selected();
    if (!person) this.sayNobodySelected(place);
    return person ?? null;
  }

  sayNobodySelected(place = null) {
    this.say(place, gettext("Nobody is selected: click on a box, or press {key}", { key: keyFor("nextPerson") }));
  }

  say(place, text) {
    if (typeof place === "function") return this.say(place(), text); // asking for it makes the browser lay out the page
    this.notices.sayAt(place && "clientX" in place ? { x: place.clientX, y: place.clientY } : place, text);
  }

  /** A place in the window for what is to be said about a person, or null. */
  besideFoot(person) {
    const pane = this.panes.active;
    const foot = pane.view.box(person) && pane.view.foot(person);
    if (!foot) return null;
    return pane.global(pane.transform.toPane(foot.x, foot.y));
  }
}
