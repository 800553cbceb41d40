import { element, setText } from "../../base/dom.js";
import { gettext, ngettext } from "../../base/messages.js";
import { warningWords } from "./warning_words.js";

/** The list of warnings under the people: open or closed as the annotator left it; a click goes there. */
export class WarningsPanel {
  /** @param {{go: (warning) => void, join: (warning) => void}} parts what the buttons of a row do */
  constructor({ store, warnings, settings, go, join }) {
    Object.assign(this, { store, warnings, settings, _go: go, _join: join });
    this._rows = new Map();
    this._list = element("ul", { id: "warning-list", tabIndex: -1 });
    this._again = element("button", { type: "button", className: "quiet", onclick: () => warnings.restore() });
    this._body = element("div", { className: "warning-body" }, this._list, this._again);
    this._toggle = element("button", {
      type: "button",
      className: "quiet warning-toggle",
      "aria-controls": "warning-list",
      onclick: (event) => {
        this.toggle();
        if (event.detail > 0) event.currentTarget.blur();
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
    this.element.dataset.count = list.length;
    this._again.hidden = dismissed === 0;
    setText(this._again, ngettext("{n} dismissed: show it again", "{n} dismissed: show them again", dismissed));
    const rows = new Map(list.map((warning) => [warning, this._rows.get(warning) ?? this._makeRow(warning)]));
    this._rows = rows;
    this._list.replaceChildren(...rows.values());
    this._markHere();
  }

  _makeRow(warning) {
    const place = this.store.numbers.indexOf(warning.frame) + 1;
    const words = warningWords(warning);
    const button = (text, properties, work) =>
      element("button", { type: "button", className: "quiet", ...properties, onclick: work }, text);
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
