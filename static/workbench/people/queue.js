import { CARRIED } from "../../truth/annotation.js";

/**
 * The order in which the people of the open frame come: from the smallest number on, always the nearest next, so
 * that eyes and pointer travel little. Whoever has a place in it keeps it as long as the frame is open.
 * @typedef {import("../../truth/annotation.js").Annotation} Annotation
 */
export class Queue {
  /** @param {{scene: import("../../truth/scene.js").Scene, store: import("../../truth/store.js").Store}} parts */
  constructor({ scene, store }) {
    this._scene = scene;
    this._store = store;
    /** @type {number[]} */
    this._order = [];
    /** @type {((persons: number[]) => number|undefined)|null} who comes before all others, if somebody does */
    this.first = null;
    store.on("frame", () => (this._order = []));
  }

  /**
   * The next yellow person after `person`, or from the beginning (null); undefined when nobody is yellow.
   * @param {number|null} person @returns {Annotation|undefined}
   */
  next(person) {
    this._extend();
    const start = person === null ? 0 : this._order.indexOf(person) + 1;
    const inTurn = [...this._order.slice(start), ...this._order.slice(0, start)];
    return inTurn.map((one) => this._store.person(one)).find((one) => one?.state === CARRIED);
  }

  /** Whoever is new comes after the others, nearest first. */
  _extend() {
    const missing = [...this._store.people().keys()]
      .filter((one) => !this._order.includes(one))
      .sort((one, other) => one - other);
    while (missing.length) {
      const next = this._nearest(missing);
      this._order.push(next);
      missing.splice(missing.indexOf(next), 1);
    }
  }

  /** @param {number[]} persons */
  _nearest(persons) {
    const first = this.first?.(persons);
    if (first !== undefined) return first;
    const last = this._order.map((one) => this._store.person(one)).findLast(Boolean);
    if (!last) return persons[0];
    const from = this._scene.metres(last.position);
    /** @param {number} one */
    const away = (one) => {
      const { x, y } = this._scene.metres(this._store.marked(one).position);
      return Math.hypot(x - from.x, y - from.y);
    };
    return persons.reduce((best, one) => (away(one) < away(best) ? one : best));
  }
}
