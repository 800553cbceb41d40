/**
 * @typedef {import("../../truth/annotation.js").People} People
 * @typedef {object} Parts
 * @property {Pick<import("../../truth/store.js").Store, "current"|"selection"|"people"|"person"|"on">} store
 * @property {{zoomed: boolean, on: (name: "zoom", listener: () => void) => void}} panes
 */

/**
 * Who was clicked into their place from afar on this visit, and not seen close up there since. Nobody clicks more
 * exactly than they see, and what stands in the first frame is carried on into all others.
 */
export class CloseLooks {
  /** @param {Parts} parts */
  constructor({ store, panes }) {
    this._store = store;
    this._panes = panes;
    /** @type {Map<number, Map<number, number>>} frame → person → the position clicked from afar */
    this._afar = new Map();
    this._before = positions(store.people());
    store.on("change", ({ frames, source }) => frames.has(store.current) && this._compare(source === "edit"));
    store.on("frame", () => (this._before = positions(store.people())));
    store.on("selection", () => this._look());
    panes.on("zoom", () => this._look());
  }

  /**
   * Whether somebody of the open frame still stands where a click from afar has put them.
   * @param {number} person
   */
  waits(person) {
    const clicked = this._afar.get(this._store.current)?.get(person);
    return clicked !== undefined && this._store.person(person)?.position === clicked;
  }

  /** How many of the open frame wait. */
  get count() {
    return [...this._store.people().keys()].filter((person) => this.waits(person)).length;
  }

  /** @param {boolean} edited */
  _compare(edited) {
    const people = this._store.people();
    if (edited && !this._panes.zoomed) {
      const here = this._afar.get(this._store.current) ?? new Map();
      for (const { person, position, state, origin } of people.values())
        if (this._before.get(person) !== position && state === "validated" && origin === "clicked")
          here.set(person, position);
      this._afar.set(this._store.current, here);
    }
    this._before = positions(people);
  }

  /** Whoever is selected while the views are zoomed is seen close up. */
  _look() {
    const { current, selection } = this._store;
    if (this._panes.zoomed && selection !== null) this._afar.get(current)?.delete(selection);
  }
}

/** @param {People} people @returns {Map<number, number>} */
function positions(people) {
  return new Map([...people.values()].map(({ person, position }) => [person, position]));
}
