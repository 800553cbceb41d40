import { element, required, setText } from "../../base/dom.js";
import { extent, pictureNumber, videoTime } from "./clocks.js";
import { widthFor } from "./pictures.js";
import { clockTime, rate } from "./words.js";

/**
 * @typedef {import("./store.js").Store} Store
 * @typedef {import("./store.js").Clock} Clock
 * @typedef {import("./pictures.js").Pictures} Pictures
 * @typedef {import("./player.js").Player} Player
 * @typedef {import("./pictures.js").Shown} Shown
 */

const GAP = 6; // CSS pixels
const CAPTION = 24;

/** How many columns make pictures largest, and how wide they are then. @param {number} count @param {number} width @param {number} height @param {number} ratio */
export function layout(count, width, height, ratio) {
  const tried = Array.from({ length: count }, (_, at) => {
    const [columns, rows] = [at + 1, Math.ceil(count / (at + 1))];
    const across = (width - GAP * (columns - 1)) / columns;
    const down = (height - GAP * (rows - 1)) / rows - CAPTION;
    return { columns, width: Math.floor(Math.min(across, down * ratio)) };
  });
  return tried.reduce((best, each) => (each.width > best.width ? each : best));
}

/** The videos side by side; each shows the picture that is nearest to the instant looked at. */
export class Tiles {
  /** @param {HTMLElement} root @param {Store} store @param {Pictures} pictures */
  constructor(root, store, pictures) {
    this._root = root;
    this._store = store;
    this._pictures = pictures;
    this.large = false; // only the reference and the selected one
    this._partner = ""; // file of the one selected last that is not the reference
    /** @type {Map<string, HTMLElement>} */
    this._tiles = new Map();
    /** @type {Map<string, number>} by file the time of the picture that is seen */
    this.seen = new Map();
    store.clocks.forEach((clock) => {
      this._tiles.set(clock.file, this._tile(clock));
    });
    root.append(...this._tiles.values());
  }

  /** The clocks whose videos are on the screen. @returns {Clock[]} */
  get shown() {
    const { clock, reference, used } = this._store;
    if (clock !== reference) this._partner = clock.file;
    if (!this.large) return used;
    const partner = used.find(({ file }) => file === this._partner) ?? used.find((each) => each !== reference);
    return used.filter((each) => each === reference || each === partner);
  }

  /** @param {Player} player */
  draw(player) {
    const { shown } = this;
    this._arrange(shown);
    for (const clock of this._store.clocks) {
      const tile = /** @type {HTMLElement} */ (this._tiles.get(clock.file));
      tile.hidden = !shown.includes(clock);
      if (!tile.hidden) this._draw(tile, clock, player);
    }
  }

  /** @param {Clock[]} shown */
  _arrange(shown) {
    const video = this._store.video(shown[0]);
    const { clientWidth, clientHeight } = this._root;
    const found = layout(shown.length, clientWidth, clientHeight, video.width / video.height);
    this._root.style.gridTemplateColumns = `repeat(${found.columns}, ${Math.max(found.width, 120)}px)`;
    this._pictures.width = widthFor(found.width * devicePixelRatio);
  }

  /** @param {HTMLElement} tile @param {Clock} clock @param {Player} player */
  _draw(tile, clock, player) {
    const store = this._store;
    const video = store.video(clock);
    const at = videoTime(clock, store.time);
    const { from, until } = extent(clock, video);
    const beyond = store.time < from - video.interval / 2 || store.time > until;
    const playing = player.playing;
    const found = beyond ? null : playing ? player.picture(clock) : this._pictures.still(store.number(clock), at);
    if (found) paint(required(tile, "canvas", HTMLCanvasElement), found);
    if (found) this.seen.set(clock.file, found.strip.times[found.row]);
    if (beyond) this.seen.delete(clock.file);
    const seen = this.seen.get(clock.file);
    tile.classList.toggle("beyond", beyond);
    tile.classList.toggle("late", !found && !beyond);
    tile.dataset.picture = found && !playing ? String(pictureNumber(video, found.strip.times[0])) : "";
    tile.setAttribute("aria-current", String(clock === store.clock));
    tile.classList.toggle("reference", clock === store.reference);
    setText(required(tile, "b", HTMLElement), `${store.clocks.indexOf(clock) + 1}  ${clock.camera}`);
    const problem = this._pictures.problems.get(store.number(clock));
    const told =
      seen === undefined ? "…" : `${clockTime(seen)} · picture ${pictureNumber(video, seen)} · ${rate(video.interval)}`;
    const where = store.time < from ? "not begun yet" : "over";
    setText(required(tile, ".at", HTMLElement), beyond ? where : problem && !found ? problem : told);
  }

  /** @param {Clock} clock */
  _tile(clock) {
    const video = this._store.video(clock);
    const canvas = element("canvas", { width: video.width, height: video.height });
    canvas.style.aspectRatio = `${video.width} / ${video.height}`;
    const words = element("figcaption", {}, element("b"), element("span", { className: "at muted" }));
    const index = this._store.clocks.findIndex(({ file }) => file === clock.file);
    const choose = () => this._store.select(index);
    return element("figure", { className: "sync-tile", "data-file": clock.file, onclick: choose }, canvas, words);
  }
}

/** @param {HTMLCanvasElement} canvas @param {Shown} shown */
function paint(canvas, { strip: { bitmap, times }, row }) {
  const height = bitmap.height / times.length;
  if (canvas.width !== bitmap.width || canvas.height !== height) Object.assign(canvas, { width: bitmap.width, height });
  canvas.getContext("2d")?.drawImage(bitmap, 0, row * height, bitmap.width, height, 0, 0, bitmap.width, height);
}
