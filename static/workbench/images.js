import { ApiError } from "./api.js";
import { Emitter } from "./emitter.js";
import { gettext } from "./messages.js";

const AT_ONCE = 6; // connections a browser opens to one server
const BUDGET = 256 * 1024 * 1024; // bytes of decoded pictures kept
const RETRIES = [1000, 4000, 15_000]; // ms

/**
 * Pictures by frame, camera and size ("light" fills a pane, "full" is for zooming). Fetched and decoded off the
 * main thread, current frame first, then its neighbours; the oldest are let go. Emits `picture` {frame, camera}.
 */
export class Images extends Emitter {
  constructor(api, frames) {
    super();
    this._api = api;
    this._addresses = new Map(frames.map(({ number, images }) => [number, new Map(images.map((one) => [one.camera, one]))]));
    this._pictures = new Map();
    this._queue = [];
    this._running = 0;
    this._wanted = new Set();
  }

  /** What there is of a picture now; asks for it if nobody has. */
  get(frame, camera, size) {
    const key = `${frame} ${camera} ${size}`;
    let picture = this._pictures.get(key);
    if (picture) {
      picture.used = performance.now();
      return picture;
    }
    const address = this._addresses.get(frame)?.get(camera)?.[size];
    picture = { key, frame, camera, address, status: "waiting", bitmap: null, error: "", tries: 0, used: performance.now() };
    this._pictures.set(key, picture);
    if (address) this._enqueue(picture, size === "full"); // sharpness of what is looked at comes before prefetching
    else Object.assign(picture, { status: "error", error: gettext("no image") });
    return picture;
  }

  /** What is decoded already; asks for nothing. @returns {ImageBitmap|null} */
  peek(frame, camera, size) {
    return this._pictures.get(`${frame} ${camera} ${size}`)?.bitmap ?? null;
  }

  /** When nothing of a frame is on its way any more. */
  settled(frame) {
    const busy = () => [...this._pictures.values()].some((one) => one.frame === frame && (one.status === "waiting" || one.status === "loading"));
    return new Promise((done) => {
      if (!busy()) return done();
      const stop = this.on("picture", () => busy() || done(stop()));
    });
  }

  /** Frames in order of importance; everything else may stop loading and be let go. */
  want(frames) {
    this._wanted = new Set(frames);
    this._queue = this._queue.filter((picture) => this._wanted.has(picture.frame) || this._forget(picture));
    for (const picture of this._pictures.values()) {
      if (picture.status === "loading" && !this._wanted.has(picture.frame)) picture.abort.abort();
    }
    for (const frame of frames) {
      for (const camera of this._addresses.get(frame)?.keys() ?? []) this.get(frame, camera, "light");
    }
    const rank = new Map(frames.map((frame, index) => [frame, index]));
    this._queue.sort((one, other) => rank.get(one.frame) - rank.get(other.frame));
    this._pump();
  }

  /** Try a failed view again. */
  retry(frame, camera) {
    for (const picture of this._pictures.values()) {
      if (picture.frame === frame && picture.camera === camera && picture.status === "error") {
        picture.tries = 0;
        this._enqueue(picture);
        this._tell(picture);
      }
    }
  }

  retryAll() {
    for (const picture of this._pictures.values()) {
      if (picture.status === "error" && this._wanted.has(picture.frame)) this.retry(picture.frame, picture.camera);
    }
  }

  _enqueue(picture, first = false) {
    picture.status = "waiting";
    if (first) this._queue.unshift(picture);
    else this._queue.push(picture);
    this._pump();
  }

  _pump() {
    while (this._running < AT_ONCE && this._queue.length) this._load(this._queue.shift());
  }

  async _load(picture) {
    this._running += 1;
    picture.status = "loading";
    picture.abort = new AbortController();
    try {
      const blob = await this._api.blob(picture.address, picture.abort.signal);
      picture.bitmap = await createImageBitmap(blob);
      picture.status = "ready";
      this._letGo();
    } catch (error) {
      this._failed(picture, error);
    } finally {
      this._running -= 1;
      this._tell(picture);
      this._pump();
    }
  }

  _failed(picture, error) {
    if (error.name === "AbortError") return this._forget(picture);
    Object.assign(picture, { status: "error", error: error instanceof TypeError ? gettext("no connection") : error.message });
    const permanent = error instanceof ApiError && error.status < 500;
    const pause = RETRIES[picture.tries];
    picture.tries += 1;
    if (!permanent && pause) {
      setTimeout(() => {
        if (picture.status === "error" && this._pictures.get(picture.key) === picture) this._enqueue(picture);
      }, pause);
    }
  }

  _tell({ frame, camera }) {
    this.emit("picture", { frame, camera });
  }

  _forget(picture) {
    picture.bitmap?.close();
    this._pictures.delete(picture.key);
    return false;
  }

  /** Keep decoded pictures within the budget: unwanted ones go first, longest unused first. */
  _letGo() {
    const decoded = [...this._pictures.values()].filter((picture) => picture.bitmap);
    let bytes = decoded.reduce((sum, { bitmap }) => sum + bitmap.width * bitmap.height * 4, 0);
    const idle = decoded.filter(({ frame }) => !this._wanted.has(frame)).sort((one, other) => one.used - other.used);
    for (const picture of idle) {
      if (bytes <= BUDGET) return;
      bytes -= picture.bitmap.width * picture.bitmap.height * 4;
      this._forget(picture);
    }
  }
}
