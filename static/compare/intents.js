import { Intents } from "../views/intents.js";

/**
 * A click chooses, a click on nobody lets go, a double click shows a view alone; nothing here can be moved.
 * @typedef {import("../views/pane.js").Pane} Pane
 */
export class CompareIntents extends Intents {
  /** @param {{store: import("./store.js").CompareStore, enlarge: (pane: Pane) => void}} parts */
  constructor({ store, enlarge }) {
    super();
    this._store = store;
    this._enlarge = enlarge;
  }

  /** @override */
  place() {
    this._store.select(null);
  }

  /** @override @param {number} key */
  select(key) {
    this._store.select(key);
  }

  /** @override @param {Pane} pane */
  enlarge(pane) {
    this._enlarge(pane);
  }
}
