import { gettext } from "../base/messages.js";

/**
 * What the desk asks of the server. A refusal becomes an Error that says why in words.
 * @typedef {{id: number, frame: number|null, person: number|null, position: number|null, text: string, role: string,
 *            at: string, resolved: boolean, answers?: CommentJSON[]}} CommentJSON
 * @typedef {{frame?: number, person?: number|null, position?: number|null}} Pin
 * @typedef {{state: string, next: number|null, waiting: number}} Decided
 */
export class DeskServer {
  /** @param {string} base address of the assignment's review, with a slash at its end */
  constructor(base) {
    this._base = base;
  }

  /** @param {string|null} reference name of a layer; null: the server's choice @returns {Promise<import("./store.js").Answer>} */
  differences(reference) {
    const query = reference === null ? "" : `?reference=${encodeURIComponent(reference)}`;
    return this._ask(`differences/${query}`);
  }

  /** @param {string} action @param {{reason?: string, category?: string}} [more] @returns {Promise<Decided>} */
  decide(action, more = {}) {
    return this._ask("decision/", { action, ...more });
  }

  /** @param {string} text @param {Pin} pin @returns {Promise<{comments: CommentJSON[]}>} */
  comment(text, pin) {
    return this._ask("comments/", { text, ...pin });
  }

  /** @param {number} comment @param {boolean} resolved @returns {Promise<{comments: CommentJSON[]}>} */
  resolve(comment, resolved) {
    return this._ask(`comments/${comment}/`, { resolved });
  }

  /** @param {string} path @param {object} [body] */
  async _ask(path, body) {
    const answer = await fetch(this._base + path, {
      method: body ? "POST" : "GET",
      cache: "no-store",
      headers: body ? { "Content-Type": "application/json", "X-CSRFToken": csrf() } : {},
      body: body ? JSON.stringify(body) : undefined,
    }).catch(() => null);
    const content = await answer?.json().catch(() => null);
    if (answer?.ok) return content;
    throw new Error(content?.message ?? gettext("The server did not answer; nothing was changed. Try again."));
  }
}

function csrf() {
  const meta = document.querySelector("meta[name=csrf-token]");
  return meta instanceof HTMLMetaElement ? meta.content : "";
}
