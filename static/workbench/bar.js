import { element, setText } from "../base/dom.js";
import { gettext, ngettext } from "../base/messages.js";
import { paintSoon } from "../base/repaint.js";
import { saveWords } from "../saving/save_words.js";
import { carriedOf } from "../truth/annotation.js";
import { titleFor } from "./keys/keys.js";

const THEME_KEY = "gtm-theme"; // shared with the ordinary pages

/** The line on top: where one is, what is left, how it is saved, and a button for everything. */
export class Bar {
  constructor({ scene, store, saver, panes, perform, home, signIn }) {
    Object.assign(this, { scene, store, saver, panes });
    this._perform = perform;
    this.element = this._build(home, signIn);
    store.on("change", () => paintSoon(this));
    store.on("frame", () => paintSoon(this));
    saver.on("status", () => paintSoon(this));
    for (const name of ["zoom", "options"]) panes.on(name, () => paintSoon(this));
    this.paint();
  }

  /** What one needs to know about the keyboard at the moment. */
  showMode(controls) {
    setText(this._mode, controls ? gettext("Buttons: Tab moves, Esc returns to annotating") : "");
  }

  _build(home, signIn) {
    this._place = element("strong", { className: "place" });
    this._left = element("span", { className: "left" });
    this._mode = element("span", { className: "mode" });
    this._saved = element("span", { className: "save-words", role: "status" });
    this._link = element("a", { href: signIn, target: "_blank", rel: "noopener", hidden: true });
    this._toggles = ["round", "zoom", "outline", "directions"].map((id) =>
      this._button(id, toggleText(id), { "aria-pressed": "false" }),
    );
    return element(
      "header",
      { className: "bar" },
      element("h1", { className: "visually-hidden" }, gettext("Workbench")),
      element(
        "a",
        { className: "home", href: home, title: gettext("Back") },
        "‹ ",
        this.scene.assignment?.batch ?? this.scene.layer?.name ?? this.scene.dataset.name,
      ),
      this._button("previousFrame", "◀", { "aria-label": gettext("Previous frame") }),
      this._place,
      this._button("nextFrame", "▶", { "aria-label": gettext("Next frame") }),
      this._left,
      element("span", { className: "gap" }),
      this._mode,
      element("span", { className: "save", "data-save": "" }, this._saved, this._link),
      this._button("undo", "↶", { "aria-label": gettext("Undo") }),
      this._button("redo", "↷", { "aria-label": gettext("Redo") }),
      ...this._toggles,
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

  _button(id, text, properties = {}) {
    return element(
      "button",
      {
        type: "button",
        className: "quiet",
        "data-action": id,
        title: titleFor(id),
        ...properties,
        onclick: (event) => {
          this._perform(id);
          // A mouse press must not leave the focus here: Space would press the button again.
          if (event.detail > 0) event.currentTarget.blur();
        },
      },
      text,
    );
  }

  paint() {
    const { store, saver } = this;
    const index = store.numbers.indexOf(store.current);
    setText(this._place, gettext("Frame {place} of {n}", { place: index + 1, n: store.numbers.length }));
    this._place.title = gettext("number {number}", { number: store.current });
    setText(this._left, this._countWords());
    const status = saver.status();
    const { text, link } = saveWords(status, saver.revision(store.current), this.scene.mode === "tutorial");
    setText(this._saved, text);
    this._saved.title = text; // where there is no room for it
    setText(this._link, link ?? "");
    this._link.hidden = !link;
    this._saved.parentElement.dataset.save = status.kind;
    const on = {
      round: this.panes.closeUp,
      zoom: this.panes.zoomed,
      outline: this.panes.options.outline,
      directions: this.panes.options.directions,
    };
    for (const button of this._toggles) button.setAttribute("aria-pressed", String(Boolean(on[button.dataset.action])));
  }

  _countWords() {
    const people = this.store.people();
    const waiting = carriedOf(people).length;
    const count = ngettext("{n} person", "{n} people", people.size);
    return waiting ? `${count} · ${ngettext("{n} yellow", "{n} yellow", waiting)}` : count;
  }
}

function toggleText(id) {
  return {
    round: gettext("One by one"),
    zoom: gettext("Zoom"),
    outline: gettext("Area"),
    directions: gettext("Arrows"),
  }[id];
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
