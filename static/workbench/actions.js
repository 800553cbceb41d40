/** What an annotator can do, by the ids of the key table. Each topic brings its rows; of two with the same id the later one counts. */
export class Actions {
  constructor() {
    this._table = {};
  }

  use(table) {
    Object.assign(this._table, table);
  }

  /** @param {KeyboardEvent} [event] of a key; a button has none */
  perform(id, event = null) {
    this._table[id]?.(event);
  }
}
