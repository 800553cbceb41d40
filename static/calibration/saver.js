import { Emitter } from "../base/emitter.js";
import { Refused } from "./server.js";

const AGAIN = 2000; // ms after which an unanswered save is sent again

/**
 * @typedef {{key: string, method: string, path: string, body?: object}} Save
 * @typedef {{answer: any, refused: string, state: null}} SaverEvents
 * @typedef {{ask: (method: string, path: string, body?: object) => Promise<any>}} Asks
 */

/**
 * Sends what is done by hand, one after the other, until the server has it. Of several saves of one thing that
 * wait, the newest is sent.
 * @extends {Emitter<SaverEvents>}
 */
export class Saver extends Emitter {
  /** @param {Asks} server @param {(again: () => void, ms: number) => void} [later] */
  constructor(server, later = (again, ms) => setTimeout(again, ms)) {
    super();
    this._server = server;
    this._later = later;
    /** @type {Save[]} */
    this._waiting = [];
    this._busy = false;
    this.stuck = false; // the server did not answer the last time
  }

  get idle() {
    return !this._busy && this._waiting.length === 0;
  }

  /** How many are not answered yet. */
  get pending() {
    return this._waiting.length;
  }

  /** What waits under a key, the newest. @param {string} key */
  waiting(key) {
    return this._waiting.findLast((save) => save.key === key);
  }

  /** @param {Save} save */
  send(save) {
    const last = this._waiting.at(-1);
    const started = this._busy && this._waiting.length === 1;
    if (last?.key === save.key && !started) this._waiting.pop();
    this._waiting.push(save);
    this.emit("state", null);
    void this._go();
  }

  async _go() {
    if (this._busy) return;
    this._busy = true;
    while (this._waiting.length) {
      const [{ method, path, body }] = this._waiting;
      try {
        const answer = await this._server.ask(method, path, body);
        this._done();
        this.emit("answer", answer);
      } catch (error) {
        if (error instanceof Refused && (error.status === 0 || error.status >= 500)) return this._again();
        this._done();
        this.emit("refused", error instanceof Error ? error.message : String(error));
      }
    }
    this._busy = false;
    this.emit("state", null);
  }

  _done() {
    this.stuck = false;
    this._waiting.shift();
  }

  _again() {
    this._busy = false;
    this.stuck = true;
    this.emit("state", null);
    this._later(() => void this._go(), AGAIN);
  }
}
