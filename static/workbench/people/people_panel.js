import { element, setText } from "../../base/dom.js";
import { gettext, ngettext } from "../../base/messages.js";
import { paintSoon } from "../../base/repaint.js";
import { asList } from "../../truth/annotation.js";

/** @type {Record<string, 1|-1|undefined>} */
const STEPS = { ArrowUp: -1, ArrowDown: 1 };

/**
 * The list of people in the frame: number, state in words, in how many views they are seen.
 * @typedef {import("../../truth/annotation.js").Annotation} Annotation
 * @typedef {object} Row
 * @property {HTMLElement} node
 * @property {HTMLElement} state
 * @property {HTMLElement} size
 * @property {HTMLElement} views
 * @property {Annotation|null} shown what it says now
 * @property {boolean|null} selected
 */
export class PeoplePanel {
  /**
   * @param {object} parts
   * @param {import("../../truth/scene.js").Scene} parts.scene
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {(person: number) => void} parts.select
   */
  constructor({ scene, store, select }) {
    this.scene = scene;
    this.store = store;
    this._select = select;
    /** @type {Map<number, Row>} */
    this._rows = new Map();
    this._list = element("ul", {
      className: "people",
      role: "listbox",
      tabIndex: 0,
      "aria-label": gettext("People in this frame"),
      onkeydown: (event) => this._onKey(event),
    });
    this._empty = element("p", { className: "empty" }, gettext("Nobody yet. Click on somebody's feet in any view."));
    this._title = element("h2", {}, gettext("People"));
    this._details = element("p", { className: "details" });
    this.element = element("aside", { className: "panel" }, this._title, this._empty, this._list, this._details);
    for (const event of /** @type {const} */ (["change", "selection", "frame"])) store.on(event, () => paintSoon(this));
    this.paint();
  }

  /** Only rows whose person changed are touched: this runs for every step of a held key. */
  paint() {
    const people = asList(this.store.people());
    const { selection } = this.store;
    this._empty.hidden = people.length > 0;
    const gone = new Set(this._rows.keys());
    people.forEach((one, index) => {
      gone.delete(one.person);
      const row = this._rowOf(one.person);
      this._place(row.node, index);
      this._refresh(row, one, one.person === selection);
    });
    for (const person of gone) {
      this._rows.get(person)?.node.remove();
      this._rows.delete(person);
    }
    this._describe();
  }

  /**
   * With the focus on the list (by Tab; a click leaves it where it was), Up and Down choose people.
   * @param {KeyboardEvent} event
   */
  _onKey(event) {
    const step = STEPS[event.key];
    const people = asList(this.store.people());
    if (!step || !people.length || event.shiftKey) return;
    event.preventDefault();
    const index = people.findIndex(({ person }) => person === this.store.selection);
    const next = people.at((Math.max(index, step > 0 ? -1 : 0) + step) % people.length);
    if (next) this._select(next.person);
  }

  /** @param {number} person */
  _rowOf(person) {
    const row = this._rows.get(person) ?? this._makeRow(person);
    this._rows.set(person, row);
    return row;
  }

  /** @param {number} person @returns {Row} */
  _makeRow(person) {
    const state = element("span", { className: "state" });
    const size = element("span", { className: "size", title: gettext("own height") });
    const views = element("span", { className: "views" });
    const node = element(
      "li",
      {
        role: "option",
        id: `person-${person}`,
        onclick: () => this._select(person),
        onmousedown: (event) => event.preventDefault(),
      },
      element("span", { className: "number" }, String(person)),
      state,
      size,
      views,
    );
    return { node, state, size, views, shown: null, selected: null };
  }

  /** @param {HTMLElement} node @param {number} index */
  _place(node, index) {
    if (this._list.children[index] !== node) this._list.insertBefore(node, this._list.children[index] ?? null);
  }

  /** @param {Row} row @param {Annotation} one @param {boolean} selected */
  _refresh(row, one, selected) {
    if (row.shown !== one) {
      row.shown = one;
      const carried = one.state === "carried";
      row.node.dataset.state = one.state;
      const state = carried ? gettext("carried over") : gettext("validated");
      setText(row.state, state);
      setText(row.size, one.height === null ? "" : gettext("{height} m", { height: one.height.toFixed(2) }));
      const seen = this.scene.seenBy(one);
      setText(row.views, ngettext("{n} view", "{n} views", seen));
    }
    if (row.selected !== selected) {
      row.selected = selected;
      row.node.setAttribute("aria-selected", String(selected));
      if (selected) this._list.setAttribute("aria-activedescendant", row.node.id);
      if (selected) row.node.scrollIntoView({ block: "nearest" });
    }
  }

  _describe() {
    const one = this.store.selected();
    if (!one) return setText(this._details, "");
    const { x, y } = this.scene.metres(one.position);
    const { height } = this.scene.cylinderOf(one);
    const words = gettext("Person {person}: x {x} m, y {y} m, height {height} m", {
      person: one.person,
      x: x.toFixed(3),
      y: y.toFixed(3),
      height: height.toFixed(2),
    });
    setText(this._details, words);
  }
}
