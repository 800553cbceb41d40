import { element, setText } from "../../base/dom.js";
import { failureWords } from "../../base/failure_words.js";
import { gettext, ngettext } from "../../base/messages.js";
import { byPerson } from "../../truth/annotation.js";
import * as commands from "../../truth/commands.js";
import { same } from "../../truth/merge.js";
import { LOOKS } from "../../views/styles.js";
import { keyFor } from "../keys/keys.js";

/**
 * @typedef {import("../../truth/annotation.js").People} People
 * @typedef {{revision: number, people: People, done: boolean, nobody: boolean}} Shown a save, drawn as ghosts
 */

/**
 * Who saved the open frame, and when: a list beside the views. The chosen save is drawn in the views as ghosts
 * over what is there now; restoring it is an edit like any other.
 */
export class FrameHistory {
  /**
   * @param {object} parts
   * @param {import("../../base/api.js").Api} parts.api
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {import("../../saving/saver.js").Saver} parts.saver
   * @param {import("../../truth/history.js").History} parts.history
   * @param {import("../../views/panes.js").Panes} parts.panes
   * @param {import("../../base/notices.js").Notices} parts.notices
   * @param {import("../placing/guard.js").Guard} parts.guard
   */
  constructor({ api, store, saver, history, panes, notices, guard }) {
    this.api = api;
    this.store = store;
    this.saver = saver;
    this.history = history;
    this.panes = panes;
    this.notices = notices;
    this.guard = guard;
    /** @type {Shown|null} */
    this._shown = null;
    this._asked = 0; // only the newest answer counts
    this._list = element("div", {
      className: "revisions",
      role: "radiogroup",
      "aria-label": gettext("Saves of this frame"),
    });
    this._words = element("p", { className: "revision-words", role: "status" });
    this._restore = element(
      "button",
      { type: "button", className: "main", disabled: true, onclick: () => this.restore() },
      gettext("Restore this"),
    );
    const close = element("button", { type: "button", onclick: () => this.close() }, gettext("Close"));
    this._title = element("h2", {});
    this.element = element(
      "section",
      {
        className: "frame-history",
        hidden: true,
        "aria-label": gettext("History of the frame"),
        onkeydown: (event) => this._onKey(event),
      },
      this._title,
      this._list,
      this._words,
      element("div", { className: "dialog-buttons" }, this._restore, close),
    );
    panes.addExtra((pane) => this._ghosts(pane));
    store.on("frame", () => !this.element.hidden && this._load());
    store.on("change", () => this._shown && this._describe(this._shown));
  }

  toggle() {
    return this.element.hidden ? this.open() : this.close();
  }

  async open() {
    let left = false; // whoever clicks elsewhere while the list is on its way keeps the keys
    addEventListener("pointerdown", () => (left = true), { once: true, capture: true });
    await this._load();
    if (!left) this._list.querySelector("input")?.focus();
  }

  async _load() {
    const number = this.store.current;
    this._asked += 1;
    const asked = this._asked;
    this.element.hidden = false;
    this._show(null);
    setText(this._title, gettext("History of frame {place}", { place: this.store.numbers.indexOf(number) + 1 }));
    setText(this._words, gettext("Loading…"));
    const revisions = await this._ask(asked, async () => {
      await this.saver.flush(); // what is on the screen is then in the list too
      return (await this.api.history(number)).revisions;
    });
    if (!revisions || asked !== this._asked) return;
    setText(
      this._words,
      revisions.length ? gettext("Choose a save to see it in the views.") : gettext("This frame was never saved."),
    );
    this._list.replaceChildren(...revisions.reverse().map((one, index) => this._row(number, one, index === 0)));
  }

  close() {
    this._asked += 1;
    this.element.hidden = true;
    this._show(null);
    if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
  }

  restore() {
    if (!this._shown || this.guard.refused()) return;
    const { revision, ...state } = this._shown;
    const number = this.store.current;
    const label = gettext("restore save {revision} of frame {place}", {
      revision,
      place: this.store.numbers.indexOf(number) + 1,
    });
    const patch = commands.restore(this.store, number, state, label);
    if (!patch.edits.length) return this.notices.say(gettext("The frame is like that already"));
    this.history.run(patch);
    this.notices.say(
      gettext("Restored as it was in save {revision} – {key} takes it back, and every save stays", {
        revision,
        key: keyFor("undo"),
      }),
    );
    this.open();
  }

  /** @param {number} number @param {import("../../base/answers.js").Revision} save @param {boolean} newest */
  _row(number, { revision, created_at: at, author, people, done }, newest) {
    const count = ngettext("{n} person", "{n} people", people);
    return element(
      "label",
      { className: "revision" },
      element("input", { type: "radio", name: "revision", onchange: () => this._choose(number, revision) }),
      element("strong", {}, `r${revision}`),
      element("time", { dateTime: at, title: new Date(at).toLocaleString() }, timeWords(new Date(at))),
      element("span", { className: "author" }, author || gettext("unknown")),
      element(
        "span",
        {},
        [count, done ? gettext("done") : "", newest ? gettext("newest") : ""].filter(Boolean).join(" · "),
      ),
    );
  }

  /** @param {number} number @param {number} revision */
  async _choose(number, revision) {
    this._asked += 1;
    const asked = this._asked;
    const state = await this._ask(asked, () => this.api.frame(number, `?revision=${revision}`));
    if (!state || asked !== this._asked) return;
    this._show({ revision, people: byPerson(state.annotations), done: state.done, nobody: state.nobody });
  }

  /** @template Answer @param {number} asked @param {() => Promise<Answer>} question @returns {Promise<Answer|null>} */
  async _ask(asked, question) {
    try {
      return await question();
    } catch (error) {
      const reason = failureWords(error);
      if (asked === this._asked) setText(this._words, gettext("The history did not arrive: {reason}.", { reason }));
      return null;
    }
  }

  /** @param {Shown|null} shown */
  _show(shown) {
    this._shown = shown;
    this._restore.disabled = shown === null;
    if (shown) this._describe(shown);
    else this._list.replaceChildren();
    this.panes.markPeople();
  }

  /** What the chosen save has different from now. @param {Shown} shown */
  _describe(shown) {
    const now = this.store.people();
    const then = shown.people;
    /** @type {(people: People, test: (person: number) => boolean) => number} */
    const count = (people, test) => [...people.keys()].filter(test).length;
    /** @type {[number, (n: number) => string][]} */
    const counted = [
      [
        count(then, (person) => !now.has(person)),
        (n) => ngettext("{n} person is not there now", "{n} people are not there now", n),
      ],
      [
        count(now, (person) => !then.has(person)),
        (n) => ngettext("{n} person was not there", "{n} people were not there", n),
      ],
      [
        count(then, (person) => now.has(person) && !same(now.get(person), then.get(person))),
        (n) => ngettext("{n} person was different", "{n} people were different", n),
      ],
    ];
    const parts = counted.filter(([n]) => n > 0);
    setText(
      this._words,
      parts.length ? parts.map(([n, words]) => words(n)).join("; ") : gettext("Everybody stands where they stand now."),
    );
  }

  /** @param {import("../../views/pane.js").Pane} pane */
  _ghosts(pane) {
    const { transform } = pane;
    if (!this._shown || !transform) return [];
    const now = this.store.people();
    return [...this._shown.people.values()]
      .filter((one) => !same(one, now.get(one.person)) && pane.view.box(one))
      .map((one) => ({
        ...pane.view.item(one, LOOKS.ghost, transform, this.panes.options),
        id: `was ${one.person}`,
      }));
  }

  /**
   * The list is a field, so its keys are its own; Escape goes back to annotating.
   * @param {KeyboardEvent} event
   */
  _onKey(event) {
    if (event.key === "Escape") this.close();
    else if (event.key === "Enter" && event.target instanceof HTMLInputElement) this.restore();
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}

/**
 * Today the time is enough.
 * @param {Date} at
 */
function timeWords(at) {
  const today = at.toDateString() === new Date().toDateString();
  /** @type {Intl.DateTimeFormatOptions} */
  const time = { hour: "2-digit", minute: "2-digit", second: "2-digit" };
  return today ? at.toLocaleTimeString([], time) : at.toLocaleString([], { day: "numeric", month: "short", ...time });
}
