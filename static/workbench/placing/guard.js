import { gettext } from "../../base/messages.js";
import { keyFor } from "../keys/keys.js";

/**
 * Who may be edited, and why not: every refusal is said where the annotator looks.
 * @typedef {import("../../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../../truth/ground_point.js").XY} XY
 * @typedef {{clientX: number, clientY: number}|XY|null} Place a pointer event, a place in the window (CSS pixels), or
 *   null for the bottom of the screen
 * @typedef {Place|(() => Place)} Where where something is said; or what answers with it
 */
export class Guard {
  /**
   * @param {object} parts
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {{readonly readOnly: string|null}} parts.saver why nothing can be saved, or null
   * @param {import("../../views/panes.js").Panes} parts.panes
   * @param {import("../../base/notices.js").Notices} parts.notices
   */
  constructor({ store, saver, panes, notices }) {
    this.store = store;
    this.saver = saver;
    this.panes = panes;
    this.notices = notices;
  }

  get editable() {
    return this.saver.readOnly === null;
  }

  /** @param {Where} [place] */
  refused(place = null) {
    if (this.editable) return false;
    this.say(place, gettext("Read-only: {reason}", { reason: this.saver.readOnly }));
    return true;
  }

  /**
   * The selected person if it may be edited.
   * @param {Where} [place]
   */
  selected(place = null) {
    if (this.refused(place)) return null;
    const person = this.store.selected();
    if (!person) this.sayNobodySelected(place);
    return person ?? null;
  }

  /** @param {Where} [place] */
  sayNobodySelected(place = null) {
    this.say(place, gettext("Nobody is selected: click on a box, or press {key}", { key: keyFor("nextPerson") }));
  }

  /** @param {Where} place @param {string} text @returns {void} */
  say(place, text) {
    if (typeof place === "function") return this.say(place(), text); // asking for it makes the browser lay out the page
    this.notices.sayAt(place && "clientX" in place ? { x: place.clientX, y: place.clientY } : place, text);
  }

  /**
   * A place in the window for what is to be said about a person, or null.
   * @param {Annotation} person @returns {XY|null}
   */
  besideFoot(person) {
    const pane = this.panes.active;
    const foot = pane.view.box(person) && pane.view.foot(person);
    if (!foot || !pane.transform) return null;
    return pane.global(pane.transform.toPane(foot.x, foot.y));
  }
}
