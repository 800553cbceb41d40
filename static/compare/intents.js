import { Intents } from "../views/intents.js";

/** A click chooses, a click on nobody lets go, a double click shows a view alone; nothing here can be moved. */
export class CompareIntents extends Intents {
  /** @param {{enlarge: (pane: object) => void}} parts */
  constructor({ store, enlarge }) {
    super();
    Object.assign(this, { _store: store, _enlarge: enlarge });
  }

  place() {
    this._store.select(null);
  }

  select(key) {
    this._store.select(key);
  }

  enlarge(pane) {
    this._enlarge(pane);
  }
}
