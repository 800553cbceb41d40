/**
 * @typedef {{frame: number, x: number, y: number}} Place
 * @typedef {{side: "before"|"after", box: number[]}} Box
 * @typedef {{frame: number, camera: string, width: number, height: number, light: string, full: string, boxes: Box[]}} Picture
 * @typedef {{id: number, kind: "join"|"return", left_at: number, came_at: number, metres: number, seconds: number,
 *   lead: number|null, state: "open"|"decided", decision: ""|"same"|"apart", decided_by: string|null,
 *   before: Place[], after: Place[], others: Place[][], pictures: Picture[][]}} Conflict
 * @typedef {{detail: (id: number) => Promise<Conflict>, decide: (id: number, decision: string) => Promise<unknown>,
 *   undo: (id: number) => Promise<unknown>}} Server
 */

/** The questions in their order: which one is shown, what was said, and the next ones fetched ahead. */
export class Queue {
  /** @param {number[]} ids @param {Server} server */
  constructor(ids, server) {
    this.ids = ids;
    this.index = 0;
    this._server = server;
    /** @type {Map<number, Promise<Conflict>>} */
    this._details = new Map();
    /** @type {Map<number, string>} what is said about each, as far as this page knows; "" for open */
    this.said = new Map();
    /** @type {number[]} what U takes back, the latest last */
    this._latest = [];
    /** @type {Promise<unknown>} one request after the other, so that a decision and its undoing keep their order */
    this._sent = Promise.resolve();
  }

  get current() {
    return this.ids[this.index];
  }

  get left() {
    return this.ids.filter((id) => !this.said.get(id)).length;
  }

  /** @param {number} id */
  detail(id) {
    let found = this._details.get(id);
    if (!found) {
      found = this._server.detail(id);
      this._details.set(id, found);
      found.then(
        (conflict) => {
          if (!this.said.has(id)) this.said.set(id, conflict.decision);
        },
        () => this._details.delete(id),
      );
    }
    return found;
  }

  /** The ones that are shown soon. */
  ahead() {
    return this.ids.slice(this.index + 1, this.index + 3);
  }

  /** @param {number} steps */
  move(steps) {
    this.index = Math.min(Math.max(this.index + steps, 0), this.ids.length - 1);
  }

  /** Say it, and go to the next one that is open. @param {"same"|"apart"} decision */
  decide(decision) {
    const id = this.current;
    if (this.said.get(id)) return null; // undone first: nothing is overwritten by a slip of the finger
    this.said.set(id, decision);
    this._latest.push(id);
    const following = this.ids.findIndex((each, index) => index > this.index && !this.said.get(each));
    const open = following === -1 ? this.ids.findIndex((each) => !this.said.get(each)) : following;
    if (open !== -1) this.index = open;
    return this._send(id, () => this._server.decide(id, decision));
  }

  /** Take back what is shown if it is decided, else the latest decision, and show it. */
  undo() {
    const id = this.said.get(this.current) ? this.current : this._latest.at(-1);
    if (id === undefined) return null;
    this._latest = this._latest.filter((each) => each !== id);
    this.said.set(id, "");
    this.index = this.ids.indexOf(id);
    return this._send(id, () => this._server.undo(id));
  }

  /** @param {number} id @param {() => Promise<unknown>} send */
  _send(id, send) {
    const sent = this._sent.then(send).catch((error) => {
      // Somebody else may have decided: the server is asked anew.
      this.said.delete(id);
      this._details.delete(id);
      this._latest = this._latest.filter((each) => each !== id);
      this.index = this.ids.indexOf(id);
      throw error;
    });
    this._sent = sent.catch(() => {});
    return sent;
  }
}
