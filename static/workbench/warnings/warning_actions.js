import { gettext } from "../../base/messages.js";
import { warningWords } from "./warning_words.js";

/**
 * @typedef {import("../../truth/plausibility.js").Warning} Warning
 * @typedef {object} Parts
 * @property {import("../../truth/store.js").Store} store
 * @property {import("./warnings.js").Warnings} warnings
 * @property {import("../frames/navigation.js").Navigation} navigation
 * @property {import("../../base/notices.js").Notices} notices
 * @property {import("../people/identity_actions.js").IdentityActions} identity
 */

/** Going from warning to warning, and doing something about them. */
export class WarningActions {
  /** @param {Parts} parts */
  constructor({ store, warnings, navigation, notices, identity }) {
    this.store = store;
    this.warnings = warnings;
    this.navigation = navigation;
    this.notices = notices;
    this.identity = identity;
    /** @type {Warning|null} */
    this._last = null;
  }

  /** Rows for the table of actions, by the ids of the key table. */
  table() {
    return { nextWarning: () => this.next(), dismissWarning: () => this.dismissLast() };
  }

  next() {
    const { list } = this.warnings;
    if (!list.length) return this.notices.say(gettext("No warnings in the frames that are loaded"));
    const at = list.findIndex(({ key }) => key === this._last?.key);
    const ahead = list.findIndex(({ frame }) => frame >= this.store.current);
    return this.go(at >= 0 ? list[(at + 1) % list.length] : list[Math.max(0, ahead)]);
  }

  /**
   * Without saying anything about the frame one leaves.
   * @param {Warning} warning
   */
  async go(warning) {
    this._last = warning;
    if (warning.frame !== this.store.current) await this.navigation.look(warning.frame);
    if (warning.frame !== this.store.current) return; // it could not be loaded, or one went on meanwhile
    this.store.select(warning.persons.findLast((person) => this.store.person(person)) ?? null);
    this.notices.say(warningWords(warning));
  }

  dismissLast() {
    const warning = this.warnings.list.find(({ key }) => key === this._last?.key);
    if (!warning) return this.notices.say(gettext("Go to a warning first"));
    this.warnings.dismiss(warning);
    this.notices.say(gettext("Dismissed: {words}", { words: warningWords(warning) }));
  }

  /** @param {Warning} warning */
  join({ persons: [person, other] }) {
    return this.identity.ask({ kind: "join", person, other });
  }
}
