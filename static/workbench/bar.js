import { element, setText } from "../base/dom.js";
import { gettext, ngettext } from "../base/messages.js";
import { paintSoon } from "../base/repaint.js";
import { saveWords } from "../saving/save_words.js";
import { carriedOf } from "../truth/annotation.js";
import { titleFor } from "./keys/keys.js";

/**
 * @typedef {object} Parts
 * @property {import("../truth/scene.js").Scene} scene
 * @property {import("../truth/store.js").Store} store
 * @property {import("../saving/saver.js").Saver} saver
 * @property {import("../views/panes.js").Panes} panes
 * @property {import("./actions.js").Perform} perform
 * @property {string} home the address one came from
 * @property {string} signIn an address
 */

const THEME_KEY = "gtm-theme"; // shared with the ordinary pages

/** The line on top: where one is, what is left, how it is saved, and a button for everything. */
export class Bar {
  /** @param {Parts} parts */
  constructor({ scene, store, saver, panes, perform, home, signIn }) {
    this.scene = scene;
    this.store = store;
    this.saver = saver;
    this.panes = panes;
    this._perform = perform;
    this._home = element("a", { className: "home", href: home, title: gettext("Back") }, "‹ ", nameOf(scene));
    this._place = element("strong", { className: "place" });
    this._left = element("span", { className: "left" });
    this._mode = element("span", { className: "mode" });
    this._words = element("span", { className: "save-words", role: "status" });
    this._link = element("a", { href: signIn, target: "_blank", rel: "noopener", hidden: true });
    this._saved = element("span", { className: "save", "data-save": "" }, this._words, this._link);
    this._toggles = toggles().map(({ id, text, isOn }) => {
      return { isOn, button: this._button(id, text, { "aria-pressed": "false" }) };
    });
    this.element = this._build();
    store.on("change", () => paintSoon(this));
    store.on("frame", () => paintSoon(this));
    saver.on("status", () => paintSoon(this));
    panes.on("zoom", () => paintSoon(this));
    panes.on("options", () => paintSoon(this));
    this.paint();
  }

  /**
   * What one needs to know about the keyboard at the moment.
   * @param {boolean} controls
   */
  showMode(controls) {
    setText(this._mode, controls ? gettext("Buttons: Tab moves, Esc returns to annotating") : "");
  }

  /** To the first of its buttons. */
  takeFocus() {
    this._home.focus();
  }

  _build() {
    return element(
      "header",
      { className: "bar" },
      element("h1", { className: "visually-hidden" }, gettext("Workbench")),
      this._home,
      this._button("previousFrame", "◀", { "aria-label": gettext("Previous frame") }),
      this._place,
      this._button("nextFrame", "▶", { "aria-label": gettext("Next frame") }),
      this._left,
      element("span", { className: "gap" }),
      this._mode,
      this._saved,
      this._button("undo", "↶", { "aria-label": gettext("Undo") }),
      this._button("redo", "↷", { "aria-label": gettext("Redo") }),
      this._button("sheet", gettext("Side by side")),
      ...this._toggles.map(({ button }) => button),
      this._button("views", gettext("Views")),
      element(
        "button",
        {
          type: "button",
          className: "quiet",
          title: gettext("Dark or light"),
          "aria-label": gettext("Dark or light"),
          onclick: toggleTheme,
        },
        "◐",
      ),
      this._button("settings", "⚙", { "aria-label": gettext("Settings") }),
      this._button("help", "?", { "aria-label": gettext("Keys and mouse") }),
    );
  }

  /** @param {string} id @param {string} text @param {Record<string, string>} [properties] */
  _button(id, text, properties = {}) {
    const button = element(
      "button",
      { type: "button", className: "quiet", "data-action": id, title: titleFor(id), ...properties },
      text,
    );
    button.addEventListener("click", (/** @type {MouseEvent} */ event) => {
      this._perform(id);
      // A mouse press must not leave the focus here: Space would press the button again.
      if (event.detail > 0) button.blur();
    });
    return button;
  }

  paint() {
    const { store, saver } = this;
    const index = store.numbers.indexOf(store.current);
    setText(this._place, gettext("Frame {place} of {n}", { place: index + 1, n: store.numbers.length }));
    this._place.title = gettext("number {number}", { number: store.current });
    setText(this._left, this._countWords());
    const status = saver.status();
    const { text, link } = saveWords(status, saver.revision(store.current), this.scene.mode === "tutorial");
    setText(this._words, text);
    this._words.title = text; // where there is no room for it
    setText(this._link, link ?? "");
    this._link.hidden = !link;
    this._saved.dataset.save = status.kind;
    for (const { button, isOn } of this._toggles) button.setAttribute("aria-pressed", String(isOn(this.panes)));
  }

  _countWords() {
    const people = this.store.people();
    const waiting = carriedOf(people).length;
    const count = ngettext("{n} person", "{n} people", people.size);
    return waiting ? `${count} · ${ngettext("{n} yellow", "{n} yellow", waiting)}` : count;
  }
}

/** @param {import("../truth/scene.js").Scene} scene */
function nameOf({ assignment, layer, dataset }) {
  return assignment?.batch ?? layer?.name ?? dataset.name;
}

/** @returns {{id: string, text: string, isOn: (panes: import("../views/panes.js").Panes) => boolean}[]} */
function toggles() {
  return [
    { id: "round", text: gettext("One by one"), isOn: ({ closeUp }) => closeUp },
    { id: "zoom", text: gettext("Zoom"), isOn: ({ zoomed }) => zoomed },
    { id: "outline", text: gettext("Border"), isOn: ({ options }) => options.outline },
    { id: "directions", text: gettext("Arrows"), isOn: ({ options }) => options.directions },
  ];
}

function toggleTheme() {
  const root = document.documentElement;
  root.dataset.theme = root.dataset.theme === "light" ? "dark" : "light";
  try {
    localStorage.setItem(THEME_KEY, root.dataset.theme);
  } catch {
    // the choice then lasts for this page only
  }
  root.dispatchEvent(new Event("themechange"));
}
