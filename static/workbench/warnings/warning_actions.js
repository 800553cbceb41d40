import { gettext } from "../../base/messages.js";
import { warningWords } from "./warning_words.js";

/** Going from warning to warning, and doing something about them. */
export class WarningActions {
  constructor({ store, warnings, navigation, notices, identity }) {
    Object.assign(this, { store, warnings, navigation, notices, identity });
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

  /** Without saying anything about the frame one leaves. */
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

  join({ persons: [person, other] }) {
    return this.identity.ask({ kind: "join", person, other });
  }
}
