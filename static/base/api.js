/** The server answered, but not with what was asked for. */
export class ApiError extends Error {
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
  constructor({ base, token, mode, csrf }) {
    this.base = base;
    this._token = token;
    this._scheme = mode === "tutorial" ? "Worker" : "Assignment";
    this._csrf = csrf;
  }

  scene() {
    return this._json("GET", "scene/");
  }

  frames(query = "") {
    return this._json("GET", `frames/${query}`);
  }

  frame(number, query = "") {
    return this._json("GET", `frames/${number}/${query}`);
  }

  history(number) {
    return this._json("GET", `frames/${number}/history/`);
  }

  saveFrame(number, body, { keepalive = false } = {}) {
    return this._json("PUT", `frames/${number}/`, body, { keepalive });
  }

  /** Boxes of people {position, height, radius}, by camera. */
  rectangles(people) {
    return this._json("POST", "rectangles/", { people });
  }

  submit() {
    return this._json("POST", "submit/", {});
  }

  checkTutorial(body) {
    return this._json("POST", "check/", body);
  }

  finishTutorial() {
    return this._json("POST", "done/", {});
  }

  /** An image's bytes; `signal` gives up on views nobody looks at any more. */
  async blob(address, signal) {
    const limited = signalOrTimeout(signal, TIMEOUT_OF_PICTURES);
    return this._fetch(address, { headers: this.headers(), signal: limited }, (response) => response.blob());
  }

  /** What says who is asking. */
  headers() {
    if (this._token) return { Authorization: `${this._scheme} ${this._token}` };
    return this._csrf ? { "X-CSRFToken": this._csrf } : {};
  }

  async _json(method, path, body, { keepalive = false } = {}) {
    const headers = { ...this.headers(), Accept: "application/json" };
    if (body !== undefined) headers["Content-Type"] = "application/json";
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

  /** `read` its body; a connection can also break, or stop, in the middle of it. */
  async _fetch(address, options, read) {
    try {
      const response = await fetch(address, { credentials: "same-origin", ...options });
      if (!response.ok) throw await errorOf(response);
      return await read(response);
    } catch (error) {
      if (error.name === "AbortError" || error instanceof ApiError) throw error;
      // A page of something on the way, a sign-in to the network for instance, is no answer of the server.
      if (error instanceof SyntaxError) throw new ApiError(200, "unreadable", error.message);
      throw new NetworkError(error.message);
    }
  }
}

async function errorOf(response) {
  const body = await response.json().catch(() => null);
  return new ApiError(response.status, body?.code ?? "unknown", body?.message ?? response.statusText, body?.details);
}

/** What AbortSignal.any does, which some browsers do not have yet. @param {AbortSignal} [signal] @param {number} ms */
function signalOrTimeout(signal, ms) {
  const both = new AbortController();
  if (signal?.aborted) both.abort(signal.reason);
  for (const one of [signal, AbortSignal.timeout(ms)]) {
    one?.addEventListener("abort", () => both.abort(one.reason), { once: true });
  }
  return both.signal;
}
