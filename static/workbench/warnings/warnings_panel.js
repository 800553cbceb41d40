import { element, setText } from "../../base/dom.js";
import { gettext, ngettext } from "../../base/messages.js";
import { warningWords } from "./warning_words.js";

/**
 * @typedef {import("../../truth/plausibility.js").Warning} Warning
 * @typedef {object} Parts
 * @property {import("../../truth/store.js").Store} store
 * @property {import("./warnings.js").Warnings} warnings
 * @property {import("../settings.js").Settings} settings
 * @property {(warning: Warning) => void} go what the buttons of a row do
 * @property {(warning: Warning) => void} join
 */

/** The list of warnings under the people: open or closed as the annotator left it; a click goes there. */
export class WarningsPanel {
  /** @param {Parts} parts */
  constructor({ store, warnings, settings, go, join }) {
    this.store = store;
    this.warnings = warnings;
    this.settings = settings;
    this._go = go;
    this._join = join;
    /** @type {Map<Warning, HTMLElement>} */
    this._rows = new Map();
    this._list = element("ul", { id: "warning-list", tabIndex: -1 });
    this._again = element("button", { type: "button", className: "quiet", onclick: () => warnings.restore() });
    this._body = element("div", { className: "warning-body" }, this._list, this._again);
    this._toggle = element("button", {
      type: "button",
      className: "quiet warning-toggle",
      "aria-controls": "warning-list",
      onclick: (/** @type {MouseEvent} */ event) => {
        this.toggle();
        if (event.detail > 0) this._toggle.blur();
      },
    });
    this.element = element(
      "section",
      { className: "warnings", "aria-label": gettext("Warnings") },
      this._toggle,
      this._body,
    );
    settings.watch("warningsOpen", (open) => this._open(open));
    warnings.on("change", () => this._update());
    store.on("frame", () => this._markHere());
    this._update();
  }

  toggle() {
    this.settings.set("warningsOpen", !this.settings.get("warningsOpen"));
  }

  /** @param {boolean} open */
  _open(open) {
    this._body.hidden = !open;
    this._toggle.setAttribute("aria-expanded", String(open));
  }

  _update() {
    const { list, dismissed } = this.warnings;
    setText(
      this._toggle,
      list.length ? `⚠ ${ngettext("{n} warning", "{n} warnings", list.length)}` : gettext("No warnings"),
    );
    this.element.dataset.count = String(list.length);
    this._again.hidden = dismissed === 0;
    setText(this._again, ngettext("{n} dismissed: show it again", "{n} dismissed: show them again", dismissed));
    const rows = new Map(list.map((warning) => [warning, this._rows.get(warning) ?? this._makeRow(warning)]));
    this._rows = rows;
    this._list.replaceChildren(...rows.values());
    this._markHere();
  }

  /** @param {Warning} warning @returns {HTMLElement} */
  _makeRow(warning) {
    const place = this.store.numbers.indexOf(warning.frame) + 1;
    const words = warningWords(warning);
    return element(
      "li",
      { "data-kind": warning.kind },
      button(
        gettext("Frame {place}: {words}", { place, words }),
        { className: "quiet go", title: gettext("Go there") },
        () => this._go(warning),
      ),
      warning.kind === "renumbered" ? button(gettext("Join…"), {}, () => this._join(warning)) : null,
      button(
        "✕",
        { title: gettext("This is right: do not warn again"), "aria-label": gettext("Dismiss: {words}", { words }) },
        () => this.warnings.dismiss(warning),
      ),
    );
  }

  _markHere() {
    for (const [warning, row] of this._rows) row.classList.toggle("here", warning.frame === this.store.current);
  }
}

/** @param {string} text @param {{[property: string]: string}} properties @param {() => void} work */
function button(text, properties, work) {
  return element("button", { type: "button", className: "quiet", ...properties, onclick: work }, text);
}
