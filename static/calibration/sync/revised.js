import { Refused } from "../server.js";

/** @typedef {import("../saver.js").Asks} Asks */

/**
 * Names in every change the revision that it was made from. After a refusal what was queued before it is not sent:
 * it was made from what the server does not have.
 */
export class Revised {
  /** @param {Asks} server @param {number} revision */
  constructor(server, revision) {
    this._server = server;
    this.revision = revision;
    this.round = 0; // changes of an earlier round are dropped
  }

  /** @param {string} method @param {string} path @param {object} [body] with its `round` @returns {Promise<any>} */
  async ask(method, path, body) {
    const { round, ...rest } = /** @type {{round: number}} */ (body);
    if (round !== this.round) throw new Refused(412, "");
    try {
      const answer = await this._server.ask(method, path, { ...rest, revision: this.revision });
      this.revision = answer.revision;
      return answer;
    } catch (error) {
      if (error instanceof Refused && error.status > 0 && error.status < 500) this.round += 1;
      throw error;
    }
  }
}
