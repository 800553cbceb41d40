import { ApiError } from "../base/api.js";
import { Emitter } from "../base/emitter.js";
import { problemWords } from "../base/failure_words.js";
import { gettext } from "../base/messages.js";
import { PictureShelf } from "./picture_shelf.js";

const AT_ONCE = 6; // connections a browser opens to one server
const BUDGET = 256 * 1024 * 1024; // bytes of decoded pictures kept
const RETRIES = [1000, 4000, 15_000]; // ms
const [OPEN, CLOSE_UP, WANTED, SHARP, REST] = [4, 3, 2, 1, 0]; // how important a picture is, see _importance

/**
 * Pictures by frame, camera and size ("light" fills a pane, "full" is for zooming). Fetched and decoded off the
 * main thread, current frame first, then its neighbours; what matters least is let go. Emits `picture` {frame, camera}.
 * @typedef {"light"|"full"} PictureSize
 * @typedef {{camera: number} & Record<PictureSize, string>} Addresses of one picture
 * @typedef {object} Picture
 * @property {string} key
 * @property {number} frame
 * @property {number} camera
 * @property {PictureSize} size
 * @property {string} address empty: there is none
 * @property {"waiting"|"loading"|"ready"|"error"} status
 * @property {ImageBitmap|null} bitmap
 * @property {string} error why it is not there
 * @property {number} tries
 * @property {number} used when somebody last asked for it
 * @property {AbortController|null} abort while it is being loaded
 * @extends {Emitter<{picture: {frame: number, camera: number}}>}
 */
export class Images extends Emitter {
  /**
   * @param {Pick<import("../base/api.js").Api, "blob">} api
   * @param {{frames: {number: number, images: Addresses[]}[], cameras: {width: number, height: number}[]}} scene
   * @param {number} [budget] bytes
   */
  constructor(api, { frames, cameras }, budget = BUDGET) {
    super();
    this._api = api;
    this._addresses = new Map(
      frames.map(({ number, images }) => [number, new Map(images.map((one) => [one.camera, one]))]),
    );
    /** @type {Map<string, Picture>} */
    this._pictures = new Map();
    /** @type {Picture[]} */
    this._queue = [];
    this._running = 0;
    /** @type {Map<number, number>} */
    this._ranks = new Map(); // wanted frame → place, the open one first
    /** @type {Map<number, number>} */
    this._closeUp = new Map(); // camera → frame that a pane shows in full
    this._fullBytes = cameras.map(({ width, height }) => 4 * width * height);
    this._lightBytes = 0; // of the largest one so far
    this._shelf = new PictureShelf(
      budget,
      (picture) => this._importance(picture),
      (picture) => this._forget(picture),
    );
  }

  /**
   * What a pane shows of a frame, sharp or not. What no pane shows any more may be let go.
   * @param {number} frame @param {number} camera @param {boolean} sharp
   */
  show(frame, camera, sharp) {
    if (!sharp) {
      this._closeUp.delete(camera);
      return this.get(frame, camera, "light");
    }
    this._closeUp.set(camera, frame);
    const full = this.get(frame, camera, "full");
    return full.bitmap ? full : this.get(frame, camera, "light");
  }

  /**
   * What there is of a picture now; asks for it if nobody has.
   * @param {number} frame @param {number} camera @param {PictureSize} size @returns {Picture}
   */
  get(frame, camera, size) {
    const key = `${frame} ${camera} ${size}`;
    const known = this._pictures.get(key);
    if (known) {
      known.used = performance.now();
      return known;
    }
    const address = this._addresses.get(frame)?.get(camera)?.[size] ?? "";
    /** @type {Picture} */
    const picture = {
      key,
      frame,
      camera,
      size,
      address,
      status: "waiting",
      bitmap: null,
      error: "",
      tries: 0,
      used: performance.now(),
      abort: null,
    };
    this._pictures.set(key, picture);
    if (address)
      this._enqueue(picture, size === "full"); // sharpness of what is looked at comes before prefetching
    else Object.assign(picture, { status: "error", error: gettext("no image") });
    return picture;
  }

  /**
   * What is decoded already; asks for nothing.
   * @param {number} frame @param {number} camera @param {PictureSize} size
   * @returns {ImageBitmap|null}
   */
  peek(frame, camera, size) {
    return this._pictures.get(`${frame} ${camera} ${size}`)?.bitmap ?? null;
  }

  /**
   * When nothing of a frame is on its way any more.
   * @param {number} frame @returns {Promise<void>}
   */
  settled(frame) {
    const busy = () =>
      [...this._pictures.values()].some(
        (one) => one.frame === frame && (one.status === "waiting" || one.status === "loading"),
      );
    return new Promise((done) => {
      if (!busy()) return done();
      const stop = this.on("picture", () => busy() || done(stop()));
    });
  }

  /**
   * Frames in order of importance; everything else may stop loading and be let go.
   * @param {number[]} frames
   */
  want(frames) {
    this._ranks = new Map(frames.map((frame, index) => [frame, index]));
    this._queue = this._queue.filter((picture) => this._isWanted(picture) || this._forget(picture));
    for (const picture of this._pictures.values()) {
      if (picture.status === "loading" && !this._isWanted(picture)) picture.abort?.abort();
    }
    for (const frame of frames) {
      for (const camera of this._addresses.get(frame)?.keys() ?? []) this.get(frame, camera, "light");
    }
    this._queue.sort((one, other) => this._place(one) - this._place(other));
    this._pump();
  }

  /**
   * Try a failed view again.
   * @param {number} frame @param {number} camera
   */
  retry(frame, camera) {
    for (const picture of this._pictures.values()) {
      if (picture.frame === frame && picture.camera === camera && isFailed(picture)) {
        picture.tries = 0;
        this._enqueue(picture);
        this._tell(picture);
      }
    }
  }

  retryAll() {
    for (const picture of this._pictures.values()) {
      if (isFailed(picture) && this._isWanted(picture)) this.retry(picture.frame, picture.camera);
    }
  }

  /** @param {Picture} picture @param {boolean} [first] */
  _enqueue(picture, first = false) {
    picture.status = "waiting";
    if (first) this._queue.unshift(picture);
    else this._queue.push(picture);
    this._pump();
  }

  /** What there is no room for is not fetched; whoever shows it later asks again. */
  _pump() {
    while (this._running < AT_ONCE && this._queue.length) {
      const picture = this._queue.shift();
      if (!picture) return;
      if (this._shelf.take(picture, this._expectedBytes(picture))) this._load(picture);
      else this._forget(picture);
    }
  }

  /** @param {Picture} picture */
  async _load(picture) {
    this._running += 1;
    picture.status = "loading";
    picture.abort = new AbortController();
    try {
      const blob = await this._api.blob(picture.address, picture.abort.signal);
      this._keep(picture, await createImageBitmap(blob));
    } catch (error) {
      this._failed(picture, error);
    } finally {
      this._running -= 1;
      this._tell(picture);
      this._pump();
    }
  }

  /** @param {Picture} picture @param {ImageBitmap} bitmap */
  _keep(picture, bitmap) {
    const bytes = 4 * bitmap.width * bitmap.height;
    Object.assign(picture, { bitmap, status: "ready" });
    if (picture.size === "light") this._lightBytes = Math.max(this._lightBytes, bytes);
    if (!this._shelf.take(picture, bytes)) this._forget(picture);
  }

  /** @param {Picture} picture @param {unknown} error */
  _failed(picture, error) {
    this._shelf.free(picture);
    if (error instanceof Error && error.name === "AbortError") return this._forget(picture);
    Object.assign(picture, { status: "error", error: problemWords(error) });
    const permanent = error instanceof ApiError && error.status < 500;
    const pause = RETRIES[picture.tries];
    picture.tries += 1;
    if (!permanent && pause) {
      setTimeout(() => {
        if (picture.status === "error" && this._pictures.get(picture.key) === picture) this._enqueue(picture);
      }, pause);
    }
  }

  /** @param {Picture} picture */
  _tell({ frame, camera }) {
    this.emit("picture", { frame, camera });
  }

  /** @param {Picture} picture @returns {false} it is not kept */
  _forget(picture) {
    this._shelf.free(picture);
    picture.bitmap?.close();
    Object.assign(picture, { bitmap: null, status: "waiting" });
    if (this._pictures.get(picture.key) === picture) this._pictures.delete(picture.key);
    return false;
  }

  /** @param {Picture} picture */
  _isWanted({ frame }) {
    return this._ranks.has(frame);
  }

  /** How many frames are wanted more. @param {Picture} picture */
  _place({ frame }) {
    return this._ranks.get(frame) ?? Infinity;
  }

  /** @param {Picture} picture */
  _expectedBytes({ size, camera }) {
    return size === "full" ? (this._fullBytes[camera] ?? 0) : this._lightBytes;
  }

  /**
   * First what is open, then what is looked at close up, then frames to come, the nearest first; sharp ones that were looked at, and the rest.
   * @param {Picture} picture
   */
  _importance({ frame, camera, size }) {
    const rank = this._ranks.get(frame);
    if (rank === undefined) return REST;
    if (size === "full") return rank === 0 && this._closeUp.get(camera) === frame ? CLOSE_UP : SHARP;
    return rank === 0 ? OPEN : WANTED + 1 / (1 + rank); // nearer frames count more
  }
}

/** Whether it did not arrive; one without an address cannot be asked for. @param {Picture} picture */
function isFailed({ status, address }) {
  return status === "error" && address !== "";
}
