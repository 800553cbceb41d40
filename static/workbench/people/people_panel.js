import { element, setText } from "../../base/dom.js";
import { gettext, ngettext } from "../../base/messages.js";
import { paintSoon } from "../../base/repaint.js";
import { asList } from "../../truth/annotation.js";

/** The list of people in the frame: number, state in words, in how many views they are seen. */
export class PeoplePanel {
  constructor({ scene, store, select }) {
    Object.assign(this, { scene, store });
    this._select = select;
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
    for (const event of ["change", "selection", "frame"]) store.on(event, () => paintSoon(this));
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
      this._place(this._rowOf(one.person), index);
      this._refresh(this._rows.get(one.person), one, one.person === selection);
    });
    for (const person of gone) {
      this._rows.get(person).node.remove();
      this._rows.delete(person);
    }
    this._describe();
  }

  /** With the focus on the list (by Tab; a click leaves it where it was), Up and Down choose people. */
  _onKey(event) {
    const step = { ArrowUp: -1, ArrowDown: 1 }[event.key];
    const people = asList(this.store.people());
    if (!step || !people.length || event.shiftKey) return;
    event.preventDefault();
    const index = people.findIndex(({ person }) => person === this.store.selection);
    this._select(people.at((Math.max(index, step > 0 ? -1 : 0) + step) % people.length).person);
  }

  _rowOf(person) {
    if (!this._rows.has(person)) this._rows.set(person, this._makeRow(person));
    return this._rows.get(person).node;
  }

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

  _place(node, index) {
    if (this._list.children[index] !== node) this._list.insertBefore(node, this._list.children[index] ?? null);
  }

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
