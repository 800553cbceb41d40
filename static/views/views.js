import { typed } from "../base/key_press.js";
import { gettext } from "../base/messages.js";
import { PLAIN, paintTone } from "./adjustments.js";

/**
 * Which views are shown, which one is large, and how bright each is; remembered by the settings.
 * @typedef {import("./adjustments.js").Tone} Tone
 * @typedef {import("./pane.js").Pane} Pane
 * @typedef {object} Parts
 * @property {import("./panes.js").AnyPanes} panes
 * @property {import("./layout.js").Layout} layout
 * @property {import("../workbench/settings.js").Settings} settings
 * @property {Pick<import("../base/notices.js").Notices, "say">} notices
 */
export class Views {
  /** @param {Parts} parts */
  constructor({ panes, layout, settings, notices }) {
    this.panes = panes;
    this.settings = settings;
    this.notices = notices;
    this._layout = layout;
    settings.watch("hiddenViews", () => this._arrange());
    settings.watch("largeView", () => this._arrange());
    settings.watch("tones", () => this._paintTones());
  }

  /** Rows for the table of actions. */
  table() {
    return {
      /** @param {KeyboardEvent|null} event a button says no number */
      toggleView: (event) => event && this._toggleNumber(Number(typed(event))),
      largeView: () => this.toggleLarge(),
      allViews: () => this.showAll(),
    };
  }

  /** @param {Pane} pane */
  isShown(pane) {
    return !pane.hidden;
  }

  /** @param {Pane} pane @param {boolean} on */
  show(pane, on) {
    if (!on && this.panes.shown.length === 1) return this.notices.say(gettext("This is the last view: it stays"));
    const others = this.settings.get("hiddenViews").filter((id) => id !== pane.view.id);
    if (!on && this.settings.get("largeView") === pane.view.id) this.settings.set("largeView", "");
    this.settings.set("hiddenViews", on ? others : [...others, pane.view.id]);
  }

  /** The pointer may lie over another view after the first press, so the second one goes back whatever is active. */
  toggleLarge() {
    if (this.settings.get("largeView")) return this.settings.set("largeView", "");
    this.enlarge(this.panes.active);
  }

  /**
   * Large with the others around it; all alike again when it is large already.
   * @param {Pane} pane
   */
  enlarge(pane) {
    this.settings.set("largeView", this.settings.get("largeView") === pane.view.id ? "" : pane.view.id);
  }

  showAll() {
    this.settings.set("largeView", "");
    this.settings.set("hiddenViews", []);
  }

  /**
   * Brightness, contrast and gamma of one view; 1 is the picture as it is.
   * @param {Pane} pane @returns {Tone}
   */
  tone(pane) {
    return { ...PLAIN, ...this.settings.get("tones")[pane.view.id] };
  }

  /** @param {Pane[]} panes @param {Partial<Tone>} values */
  setTone(panes, values) {
    const tones = { ...this.settings.get("tones") };
    for (const pane of panes) tones[pane.view.id] = { ...PLAIN, ...tones[pane.view.id], ...values };
    this.settings.set("tones", tones);
  }

  /** @param {number} number from 1 */
  _toggleNumber(number) {
    const pane = this.panes.all[number - 1];
    if (!pane) return this.notices.say(gettext("There is no view {number}", { number }));
    const hides = this.isShown(pane);
    const last = hides && this.panes.shown.length === 1;
    this.show(pane, !hides);
    if (hides && !last)
      this.notices.say(gettext("{view} is hidden – {number} shows it again", { view: pane.view.title, number }));
  }

  /** Names of views come from what was remembered, so they may be of another dataset. */
  _arrange() {
    const { panes } = this;
    const hidden = new Set(this.settings.get("hiddenViews"));
    const all = panes.all.every((pane) => hidden.has(pane.view.id));
    for (const pane of panes.all) pane.hidden = !all && hidden.has(pane.view.id);
    const large = panes.shown.find((pane) => pane.view.id === this.settings.get("largeView")) ?? null;
    this._layout.setLarge(panes.shown.length > 1 ? large : null);
    for (const pane of panes.shown) pane.measure();
    if (panes.active.hidden) panes.activate(panes.shown[0]);
    if (panes.zoomed) panes.zoom(true);
  }

  _paintTones() {
    for (const pane of this.panes.all) paintTone(pane, this.tone(pane));
  }
}
