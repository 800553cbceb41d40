/**
 * @typedef {(event: KeyboardEvent|null) => unknown} Action of a key; a button gives no event
 * @typedef {Record<string, Action>} ActionTable
 * @typedef {(id: string, event?: KeyboardEvent|null) => void} Perform
 */

/** What an annotator can do, by the ids of the key table. Each topic brings its rows; of two with the same id the later one counts. */
export class Actions {
  constructor() {
    /** @type {ActionTable} */
    this._table = {};
  }

  /** @param {ActionTable} table @returns {ActionTable} all rows as they were before */
  use(table) {
    const before = this._table;
    this._table = { ...before, ...table };
    return before;
  }

  /** @param {string} id @param {KeyboardEvent|null} [event] of a key; a button has none */
  perform(id, event = null) {
    this._table[id]?.(event);
  }
}
