/**
 * @typedef {import("./answers.js").Details} Details
 * @typedef {import("./answers.js").Problem} Problem
 */

/** The server answered, but not with what was asked for. */
export class ApiError extends Error {
  /** @param {number} status @param {string} code @param {string} message @param {Details|Problem[]|null} [details] */
  constructor(status, code, message, details) {
    super(message);
    this.status = status;
    this.code = code;
    this.details = details;
  }

  get signedOut() {
    return this.status === 401 || (this.status === 403 && this.code !== "read_only");
  }
}

/** The server could not be reached, or did not answer in time. */
export class NetworkError extends Error {}

const TIMEOUT = 20_000; // ms; a save is a few kilobytes, so anything slower is a dead connection
const TIMEOUT_OF_PICTURES = 120_000;

/** What the workbench calls. `base` ends with a slash. */
export class Api {
  /** @param {{base: string, token?: string, mode?: string, csrf?: string}} access */
  constructor({ base, token, mode, csrf }) {
    this.base = base;
    this._token = token;
    this._scheme = mode === "tutorial" ? "Worker" : "Assignment";
    this._csrf = csrf;
  }

  /** @returns {Promise<import("./answers.js").SceneAnswer>} */
  scene() {
    return this._json("GET", "scene/");
  }

  /** @param {string} [query] @returns {Promise<import("./answers.js").FramesAnswer>} */
  frames(query = "") {
    return this._json("GET", `frames/${query}`);
  }

  /** @param {number} number @param {string} [query] @returns {Promise<import("./answers.js").FrameAnswer>} */
  frame(number, query = "") {
    return this._json("GET", `frames/${number}/${query}`);
  }

  /** @param {number} number @returns {Promise<import("./answers.js").HistoryAnswer>} */
  history(number) {
    return this._json("GET", `frames/${number}/history/`);
  }

  /**
   * @param {number} number @param {import("./answers.js").SaveBody} body @param {{keepalive?: boolean}} [options]
   * @returns {Promise<import("./answers.js").FrameAnswer>}
   */
  saveFrame(number, body, { keepalive = false } = {}) {
    return this._json("PUT", `frames/${number}/`, body, { keepalive });
  }

  /**
   * Boxes of people, by camera.
   * @param {import("./answers.js").Sized[]} people
   * @returns {Promise<import("./answers.js").RectanglesAnswer>}
   */
  rectangles(people) {
    return this._json("POST", "rectangles/", { people });
  }

  /**
   * Whatever parts ask for that are fetched later.
   * @param {string} method @param {string} path @param {unknown} [body]
   */
  ask(method, path, body) {
    return this._json(method, path, body);
  }

  /** @returns {Promise<import("./answers.js").SubmitAnswer>} */
  submit() {
    return this._json("POST", "submit/", {});
  }

  /** @param {import("./answers.js").CheckBody} body @returns {Promise<import("./answers.js").Verdict>} */
  checkTutorial(body) {
    return this._json("POST", "check/", body);
  }

  /** @returns {Promise<import("./answers.js").TutorialDoneAnswer>} */
  finishTutorial() {
    return this._json("POST", "done/", {});
  }

  /**
   * An image's bytes; `signal` gives up on views nobody looks at any more.
   * @param {string} address @param {AbortSignal|null} [signal]
   */
  async blob(address, signal) {
    const options = { headers: this.headers(), signal: signalOrTimeout(signal ?? null, TIMEOUT_OF_PICTURES) };
    return this._fetch(address, options, (response) => response.blob());
  }

  /**
   * What says who is asking.
   * @returns {Record<string, string>}
   */
  headers() {
    if (this._token) return { Authorization: `${this._scheme} ${this._token}` };
    return this._csrf ? { "X-CSRFToken": this._csrf } : {};
  }

  /** @param {string} method @param {string} path @param {unknown} [body] @param {{keepalive?: boolean}} [options] */
  async _json(method, path, body, { keepalive = false } = {}) {
    /** @type {Record<string, string>} */
    const headers = { ...this.headers(), Accept: "application/json" };
    if (body !== undefined) headers["Content-Type"] = "application/json";
    /** @type {RequestInit} */
    const options = {
      method,
      headers,
      keepalive,
      body: body === undefined ? undefined : JSON.stringify(body),
      signal: AbortSignal.timeout(TIMEOUT), // with `keepalive` too: the page is often only hidden
      cache: "no-store",
    };
    return this._fetch(this.base + path, options, (response) => response.json());
  }

  /**
   * `read` its body; a connection can also break, or stop, in the middle of it.
   * @template Body
   * @param {string} address @param {RequestInit} options @param {(response: Response) => Promise<Body>} read
   */
  async _fetch(address, options, read) {
    try {
      const response = await fetch(address, { credentials: "same-origin", ...options });
      if (!response.ok) throw await errorOf(response);
      return await read(response);
    } catch (error) {
      if (error instanceof ApiError || isAbort(error)) throw error;
      // A page of something on the way, a sign-in to the network for instance, is no answer of the server.
      if (error instanceof SyntaxError) throw new ApiError(200, "unreadable", error.message);
      throw new NetworkError(messageOf(error));
    }
  }
}

/** @param {unknown} error */
function isAbort(error) {
  return error instanceof Error && error.name === "AbortError";
}

/**
 * What an error says of itself, whatever was thrown.
 * @param {unknown} error
 */
export function messageOf(error) {
  return error instanceof Error ? error.message : String(error);
}

/** @param {Response} response */
async function errorOf(response) {
  const body = await response.json().catch(() => null);
  return new ApiError(response.status, body?.code ?? "unknown", body?.message ?? response.statusText, body?.details);
}

/** What AbortSignal.any does, which some browsers do not have yet. @param {AbortSignal|null} signal @param {number} ms */
function signalOrTimeout(signal, ms) {
  const both = new AbortController();
  if (signal?.aborted) both.abort(signal.reason);
  for (const one of [signal, AbortSignal.timeout(ms)]) {
    one?.addEventListener("abort", () => both.abort(one.reason), { once: true });
  }
  return both.signal;
}
