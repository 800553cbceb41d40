import { element, setText } from "../../base/dom.js";
import { groupBy } from "../../base/group_by.js";
import { chord } from "../../base/key_press.js";
import { gettext } from "../../base/messages.js";
import { clash, groupTitle, keyName, keyTable } from "./keys.js";

/**
 * @typedef {import("./keys.js").KeyRow} KeyRow
 * @typedef {{row: KeyRow, key: string|null, button: HTMLElement}} Waiting `key`: the one to be replaced, if it has any
 */

const MODIFIERS = ["Shift", "Control", "Alt", "Meta", "AltGraph"];

/** All keys, group by group. A key that is clicked waits for the one that is to take its place. */
export class KeySheet {
  /** @param {import("../settings.js").Settings} settings */
  constructor(settings) {
    this._settings = settings;
    /** @type {Waiting|null} */
    this._waiting = null;
    this.message = element("p", { className: "key-message", role: "status" });
    this.element = element("div", { className: "key-groups" });
    this.reset = element(
      "button",
      { type: "button", className: "quiet", onclick: () => this._reset() },
      gettext("All keys as they were at first"),
    );
    this._build();
    this.element.addEventListener("keydown", (/** @type {KeyboardEvent} */ event) => this._onKey(event));
    this.element.addEventListener("focusout", () => this._stopWaiting());
    this._explain();
  }

  _build() {
    const groups = groupBy(keyTable(), ({ group }) => group);
    this.element.replaceChildren(
      ...[...groups].map(([group, rows]) =>
        element(
          "section",
          {},
          element("h3", {}, groupTitle(group)),
          element(
            "dl",
            {},
            rows.flatMap((row) => this._row(row)),
          ),
        ),
      ),
    );
  }

  /** @param {KeyRow} row */
  _row(row) {
    const keys = row.keys.map((key) => (row.fixed ? element("kbd", {}, keyName(key)) : this._keyButton(row, key)));
    const nothing = row.keys.length ? [] : [this._keyButton(row, null)];
    return [element("dt", {}, keys, nothing), element("dd", {}, row.label)];
  }

  /** @param {KeyRow} row @param {string|null} key null: it has none, as somebody else has taken it */
  _keyButton(row, key) {
    const name = key === null ? gettext("no key") : keyName(key);
    const button = element(
      "button",
      {
        type: "button",
        className: "key",
        "data-key-of": row.id,
        title: gettext("Change this key"),
        "aria-label": gettext("{key}: {what}. Change", { key: name, what: row.label }),
      },
      element("kbd", {}, name),
    );
    button.addEventListener("click", () => this._wait({ row, key, button }));
    return button;
  }

  /** @param {Waiting} waiting */
  _wait(waiting) {
    const { row, button } = waiting;
    this._stopWaiting();
    this._waiting = waiting;
    button.classList.add("waiting");
    button.focus();
    setText(this.message, gettext("Press the new key for “{what}”; Esc leaves it as it is", { what: row.label }));
  }

  _stopWaiting() {
    this._waiting?.button.classList.remove("waiting");
    this._waiting = null;
  }

  /** @param {KeyboardEvent} event */
  _onKey(event) {
    if (!this._waiting || MODIFIERS.includes(event.key)) return;
    event.preventDefault();
    event.stopPropagation();
    if (event.key === "Escape") {
      this._stopWaiting();
      return this._explain();
    }
    this._take(this._waiting, chord(event));
  }

  /**
   * A key that means something else already is refused, and one can press another at once.
   * @param {Waiting} waiting @param {string} pressed
   */
  _take({ row, key }, pressed) {
    const other = clash(row.id, pressed);
    if (other)
      return setText(
        this.message,
        gettext("{key} is already used: {what}. Press another key, or Esc", {
          key: keyName(pressed),
          what: other.label,
        }),
      );
    const kept = row.keys.map((one) => (one === key ? pressed : one));
    this._stopWaiting();
    this._settings.set("keys", {
      ...this._settings.get("keys"),
      [row.id]: [...new Set(kept.length ? kept : [pressed])],
    });
    this._build();
    this._buttonOf(row.id)?.focus();
    setText(this.message, gettext("{key} now means: {what}", { key: keyName(pressed), what: row.label }));
  }

  /** @param {string} id @returns {HTMLElement|null} */
  _buttonOf(id) {
    return this.element.querySelector(`[data-key-of="${id}"]`);
  }

  _reset() {
    this._settings.reset("keys");
    this._build();
    setText(this.message, gettext("All keys are as they were at first"));
  }

  _explain() {
    setText(this.message, gettext("Click on a key to change it."));
  }
}
