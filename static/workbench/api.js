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
    const response = await this._fetch(address, { headers: this.headers(), signal });
    if (!response.ok) throw await errorOf(response);
    return response.blob();
  }

  /** What says who is asking. */
  headers() {
    if (this._token) return { Authorization: `${this._scheme} ${this._token}` };
    return this._csrf ? { "X-CSRFToken": this._csrf } : {};
  }

  async _json(method, path, body, { keepalive = false } = {}) {
    const headers = { ...this.headers(), Accept: "application/json" };
    if (body !== undefined) headers["Content-Type"] = "application/json";
    const response = await this._fetch(this.base + path, {
      method,
      headers,
      keepalive,
      body: body === undefined ? undefined : JSON.stringify(body),
      signal: keepalive ? undefined : AbortSignal.timeout(TIMEOUT),
      cache: "no-store",
    });
    if (!response.ok) throw await errorOf(response);
    return response.json();
  }

  async _fetch(address, options) {
    try {
      return await fetch(address, { credentials: "same-origin", ...options });
    } catch (error) {
      if (error.name === "AbortError") throw error;
      throw new NetworkError(error.message);
    }
  }
}

async function errorOf(response) {
  const body = await response.json().catch(() => ({}));
  return new ApiError(response.status, body.code ?? "unknown", body.message ?? response.statusText, body.details);
}
