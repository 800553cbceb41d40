import { pictureNumber, pictureTime } from "./clocks.js";

/**
 * @typedef {import("./clocks.js").Video} Video
 * @typedef {{bitmap: ImageBitmap, times: number[]}} Strip pictures one below the other, and their times
 * @typedef {{strip: Strip, row: number}} Shown
 * @typedef {{busy: boolean, wanted: number|null}} Slot
 */

const KEPT = 120e6; // bytes of decoded pictures
const WIDTHS = [480, 960, 1920];

/** The smallest width the server has for so many pixels of the screen. @param {number} pixels */
export const widthFor = (pixels) => WIDTHS.find((width) => width >= 0.85 * pixels) ?? WIDTHS[WIDTHS.length - 1];

/** Pictures of the videos from the server; of each video one is fetched at a time, the one wanted last. */
export class Pictures {
  /** @param {string} base address of the draft @param {Video[]} videos @param {(index: number) => void} arrived */
  constructor(base, videos, arrived) {
    this._base = base;
    this._videos = videos;
    this._arrived = arrived;
    this.width = 480;
    /** @type {Map<string, Strip>} the one used last is the last */
    this._kept = new Map();
    /** @type {Slot[]} */
    this._slots = videos.map(() => ({ busy: false, wanted: null }));
    /** @type {Map<number, string>} by video what the server said about it last */
    this.problems = new Map();
  }

  /**
   * The picture nearest to an instant, if it is here; else it is fetched, and `arrived` tells.
   * @param {number} index of the video @param {number} at seconds @returns {Shown|null}
   */
  still(index, at) {
    const video = this._videos[index];
    const regular = pictureTime(video, pictureNumber(video, at));
    const found = this._strip(index, regular);
    // Where the rate is even, that is the nearest one; elsewhere the server is asked for the very instant.
    if (found && isNearest(found.times[0], at, video)) return { strip: found, row: 0 };
    const wanted = found ? at : regular;
    const exact = found ? this._strip(index, at) : undefined;
    if (exact) return { strip: exact, row: 0 };
    void this._fetchStill(index, wanted);
    return null;
  }

  /**
   * @param {number} index @param {number} at seconds of the first @param {number} step seconds @param {number} count
   * @returns {Promise<Strip>}
   */
  strip(index, at, step, count) {
    const query = { at: Math.round(1000 * at), step: Math.round(1000 * step), count, width: Math.min(this.width, 960) };
    return this._load(index, "strip.jpg", query);
  }

  /** @param {number} index @param {number} at @returns {Strip|undefined} */
  _strip(index, at) {
    const key = this._key(index, at);
    const found = this._kept.get(key);
    if (found) {
      this._kept.delete(key);
      this._kept.set(key, found);
    }
    return found;
  }

  /** @param {number} index @param {number} at */
  _key(index, at) {
    return `${index} ${Math.round(1000 * at)} ${this.width}`;
  }

  /** @param {number} index @param {number} at */
  async _fetchStill(index, at) {
    const slot = this._slots[index];
    slot.wanted = at;
    if (slot.busy) return;
    slot.busy = true;
    while (slot.wanted !== null) {
      /** @type {number} */
      const wanted = slot.wanted;
      const key = this._key(index, wanted);
      try {
        this._keep(key, await this._load(index, "picture.jpg", { at: Math.round(1000 * wanted), width: this.width }));
        this.problems.delete(index);
      } catch (error) {
        this.problems.set(index, error instanceof Error ? error.message : String(error));
      }
      if (slot.wanted === wanted) slot.wanted = null;
    }
    slot.busy = false;
    this._arrived(index);
  }

  /** @param {string} key @param {Strip} strip */
  _keep(key, strip) {
    this._kept.set(key, strip);
    let bytes = [...this._kept.values()].reduce((sum, { bitmap }) => sum + 4 * bitmap.width * bitmap.height, 0);
    for (const [old, { bitmap }] of this._kept) {
      if (bytes <= KEPT || old === key) break;
      bytes -= 4 * bitmap.width * bitmap.height;
      bitmap.close();
      this._kept.delete(old);
    }
  }

  /** @param {number} index @param {string} name @param {{[key: string]: number}} query @returns {Promise<Strip>} */
  async _load(index, name, query) {
    const words = new URLSearchParams({ v: this._videos[index].version });
    for (const [key, value] of Object.entries(query)) words.set(key, String(value));
    const answer = await fetch(`${this._base}videos/${index}/${name}?${words}`).catch(() => null);
    if (!answer) throw new Error("The server does not answer.");
    if (!answer.ok) throw new Error(await reason(answer));
    const times = (answer.headers.get("X-Picture-Times") ?? "").split(" ").map(Number);
    return { bitmap: await createImageBitmap(await answer.blob()), times };
  }
}

/** @param {number} time of the picture @param {number} at @param {Video} video */
function isNearest(time, at, video) {
  return Math.abs(time - at) <= video.interval / 2 + 0.001;
}

/** @param {Response} answer */
async function reason(answer) {
  const content = await answer.json().catch(() => null);
  return content?.details?.[0]?.reason ?? content?.message ?? `The server answered ${answer.status}.`;
}
