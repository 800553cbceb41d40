import { element } from "../base/dom.js";
import { gettext, ngettext } from "../base/messages.js";
import { KINDS, ORDER, signOf } from "./marks.js";

/**
 * The side panel: what the frame's line of the table says, and everybody in it, mistakes first.
 * @typedef {import("./store.js").CompareStore} CompareStore
 * @typedef {import("./store.js").Mark} Mark
 */
export class MarksPanel {
  /**
   * @param {CompareStore} store @param {{truth: string, found: string}} names @param {(key: number) => void} select
   */
  constructor(store, names, select) {
    this._store = store;
    this._select = select;
    this._counts = element("p", { className: "counts" });
    this._list = element("ul", { className: "people marks", role: "listbox", "aria-label": gettext("People") });
    this.element = element(
      "aside",
      { className: "panel" },
      element("h2", {}, gettext("People in this frame")),
      this._counts,
      this._list,
      element("p", { className: "details" }, gettext("Ring: {truth} · dot: {found}", names)),
    );
    store.on("frame", () => this.show());
    store.on("marks", () => this.show());
    store.on("selection", () => this._showSelection());
    this.show();
  }

  show() {
    const { line } = this._store;
    /** @type {import("./store.js").Kind[]} */
    const kinds = line.moved === undefined ? ORDER : [...ORDER.slice(0, -1), "moved", "matched"];
    this._counts.replaceChildren(
      ...kinds.map((kind) => {
        const count = kind === "matched" ? line.matched - line.swapped : (line[kind] ?? 0);
        return element("span", {}, signOf(kind), ` ${count} ${KINDS[kind].words()}`);
      }),
    );
    this._list.replaceChildren(...this._store.marks().map((mark) => this._row(mark)));
    this._showSelection();
  }

  /** @param {Mark} mark */
  _row(mark) {
    return element(
      "li",
      { role: "option", "data-kind": mark.kind, "data-key": mark.key, onclick: () => this._select(mark.key) },
      signOf(mark.kind),
      element("span", { className: "number" }, String(mark.shown.person)),
      element("span", { className: "state" }, this._told(mark)),
    );
  }

  /** @param {Mark} mark */
  _told({ kind, truth, found, before, distance, shown }) {
    const centimetres = Math.round((distance ?? 0) * 1000) / 10;
    if (kind === "missed") return gettext("missed");
    if (kind === "extra") return gettext("extra");
    if (distance === null) return ""; // there is nothing to compare with
    const away = ngettext("{n} cm off", "{n} cm off", centimetres);
    if (kind === "swapped") return gettext("was {before}, now {now}, {away}", { before, now: found.person, away });
    if (truth.person === found.person) return away;
    if (shown === found) return gettext("{number} in the reference, {away}", { number: truth.person, away });
    return gettext("found as {now}, {away}", { now: found.person, away });
  }

  _showSelection() {
    for (const row of this._list.children) {
      const chosen = row.getAttribute("data-key") === String(this._store.selection);
      row.setAttribute("aria-selected", String(chosen));
      if (chosen) row.scrollIntoView({ block: "nearest" });
    }
  }
}
