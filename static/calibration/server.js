/** A refusal of the server, in its words; `status` 0: it did not answer. */
export class Refused extends Error {
  /** @param {number} status @param {string} message */
  constructor(status, message) {
    super(message);
    this.status = status;
  }
}

/** What a desk's pages ask of the server. */
export class Server {
  /** @param {string} base address of the desk, with a slash at its end @param {string} csrf */
  constructor(base, csrf) {
    this.base = base;
    this._csrf = csrf;
  }

  /** @param {string} digest */
  picture(digest) {
    return `${this.base}pictures/${digest}.jpg`;
  }

  /**
   * @param {string} method @param {string} path @param {object} [body]
   * @returns {Promise<any>} the answer; rejects with Refused
   */
  async ask(method, path, body) {
    const headers = { Accept: "application/json", "Content-Type": "application/json", "X-CSRFToken": this._csrf };
    const options = { method, headers, keepalive: method !== "GET", body: body && JSON.stringify(body) };
    const answer = await fetch(this.base + path, { ...options, cache: "no-store" }).catch(() => null);
    if (!answer) throw new Refused(0, "The server does not answer.");
    const content = await answer.json().catch(() => null);
    if (answer.ok) return content;
    const reasons = Array.isArray(content?.details) ? content.details.map(reason) : [];
    throw new Refused(answer.status, reasons.join(" ") || content?.message || `The server answered ${answer.status}.`);
  }
}

/** @param {{reason: string}} detail */
function reason({ reason }) {
  return reason;
}
