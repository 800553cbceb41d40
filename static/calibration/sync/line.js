import { element, setText } from "../../base/dom.js";
import { apart, extent, sharedTime } from "./clocks.js";
import { clockTime, inPictures, rate, signed } from "./words.js";

/**
 * @typedef {import("./store.js").Store} Store
 * @typedef {import("./store.js").Clock} Clock
 * @typedef {import("./store.js").Place} Place
 */

const SURE = { sure: "sure", likely: "likely, look closely", none: "not found" };
const HEADS = ["", "Camera", "", "Offset, s", "Drift ppm", "", "First guess"];

/** One row for each video: when it lasts on the time all share, and what its clock says. */
export class TimeLine {
  /** @param {HTMLElement} root @param {Store} store */
  constructor(root, store) {
    this._store = store;
    this._heads = HEADS.map((word) => element("span", { className: "head" }, word));
    this._rows = store.clocks.map((_, index) => row(store, index));
    this._hand = element("i", { className: "hand" });
    this._both = element("i", { className: "both" });
    this._bars = element("div", { className: "bars" }, this._both, ...this._rows.map(({ bar }) => bar), this._hand);
    this._ruler = element("div", { className: "ruler" });
    root.style.setProperty("--rows", String(this._rows.length));
    root.append(...this._heads, ...this._rows.flatMap(({ before, after }) => [...before, ...after]), this._bars);
    this._heads[2].append(this._ruler);
    this._rows.forEach(({ before, after }, at) => {
      for (const cell of [...before, ...after]) cell.style.gridRow = String(at + 2);
    });
    for (const target of [this._bars, this._ruler]) this._listen(target);
  }

  draw() {
    const { _store: store } = this;
    const { from, until } = store.bounds;
    const share = (/** @type {number} */ time) => `${(100 * (time - from)) / Math.max(until - from, 1e-6)}%`;
    setText(this._heads[5], store.event ? `${store.event.name}: apart` : "Apart");
    this._hand.style.left = share(store.time);
    const { shared } = store;
    this._both.hidden = shared.until <= shared.from;
    this._both.style.left = share(shared.from);
    this._both.style.right = `calc(100% - ${share(shared.until)})`;
    this._drawRuler(from, until, share);
    store.clocks.forEach((clock, index) => {
      this._rows[index].draw(clock, share);
    });
  }

  /** @param {number} from @param {number} until @param {(time: number) => string} share */
  _drawRuler(from, until, share) {
    const steps = [0.1, 0.5, 1, 2, 5, 10, 30, 60, 120, 300, 600, 1800, 3600];
    const step = steps.find((each) => (until - from) / each <= 8) ?? 7200;
    const last = until - 0.03 * (until - from); // its label stays within
    const count = Math.floor(last / step) - Math.ceil(from / step) + 1;
    const ticks = Array.from({ length: Math.max(count, 0) }, (_, at) => (Math.ceil(from / step) + at) * step);
    this._ruler.replaceChildren(
      ...ticks.map((time) => {
        const tick = element("span", {}, clockTime(time).replace(step < 1 ? /00$/ : /\.000$/, ""));
        tick.style.left = share(time);
        return tick;
      }),
    );
  }

  /** @param {HTMLElement} target */
  _listen(target) {
    const scrub = (/** @type {PointerEvent} */ event) => {
      const { left, width } = this._bars.getBoundingClientRect();
      const { from, until } = this._store.bounds;
      this._store.goTo(from + ((event.clientX - left) / width) * (until - from));
    };
    target.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      target.setPointerCapture(event.pointerId);
      scrub(event);
    });
    target.addEventListener("pointermove", (event) => {
      if (target.hasPointerCapture(event.pointerId)) scrub(event);
    });
  }
}

/** @param {Store} store @param {number} index */
function row(store, index) {
  const used = element("input", { type: "checkbox", title: "Import this video" });
  used.addEventListener("change", () => store.setClock(index, { used: used.checked }));
  const pick = element("button", { type: "button", className: "pick", onclick: () => store.select(index) });
  const name = element("input", { type: "text", className: "name", "aria-label": "Name of the camera", maxLength: 80 });
  name.addEventListener("change", () => store.setClock(index, { camera: name.value.trim() }));
  const [offset, drift] = /** @type {const} */ (["offset", "drift"]).map((what) => number(store, index, what));
  const [difference, guess] = ["apart", "guess"].map((className) => element("span", { className }));
  const bar = element("div", { className: "bar-row" });
  const before = [element("span", { className: "who" }, used, pick), name];
  const after = [offset, drift, difference, guess];

  /** @param {Clock} clock @param {(time: number) => string} share */
  const draw = (clock, share) => {
    used.checked = clock.used;
    setText(pick, `${index + 1}`);
    for (const part of [pick, bar]) part.setAttribute("aria-current", String(index === store.index));
    put(name, clock.camera);
    put(offset, clock.offset.toFixed(4));
    put(drift, clock.drift.toFixed(1));
    setText(difference, differs(store, clock));
    difference.title = store.event && store.event.marks[clock.file] !== undefined ? "marked" : "not marked";
    setText(guess, guessed(store, clock));
    const video = store.video(clock);
    const { from, until } = extent(clock, video);
    const body = element("i", {
      className: `extent${clock.used ? "" : " unused"}`,
      title: `${clock.file}, ${rate(video.interval)}`,
    });
    body.style.left = share(from);
    body.style.right = `calc(100% - ${share(until)})`;
    const marks = store.draft.events.flatMap((event) => {
      const at = event.marks[clock.file];
      if (at === undefined) return [];
      const mark = element("i", { className: `event${event === store.event ? " chosen" : ""}`, title: event.name });
      mark.style.left = share(sharedTime(clock, at));
      return [mark];
    });
    bar.replaceChildren(body, ...marks);
  };
  return { before, after, bar, draw };
}

/** @param {Store} store @param {number} index @param {"offset"|"drift"} what */
function number(store, index, what) {
  const label = what === "offset" ? "Offset, seconds" : "Drift, parts per million";
  const step = what === "offset" ? "0.001" : "0.1";
  const field = element("input", { type: "number", step, className: what, "aria-label": label });
  field.addEventListener("change", () => {
    if (Number.isFinite(field.valueAsNumber)) store.setClock(index, { [what]: field.valueAsNumber });
  });
  return field;
}

/** Not while somebody writes in it. @param {HTMLInputElement} field @param {string} value */
function put(field, value) {
  if (document.activeElement !== field && field.value !== value) field.value = value;
}

/** @param {Store} store @param {Clock} clock */
function differs(store, clock) {
  const { event, markReference } = store;
  if (!event || event.marks[clock.file] === undefined) return event ? "–" : "";
  if (clock === markReference) return "told from here";
  const later = apart(event, clock, markReference) ?? 0;
  return `${signed(later)} · ${inPictures(later, store.video(clock).interval)}`;
}

/** @param {Store} store @param {Clock} clock */
function guessed(store, clock) {
  const place = store.draft.guess.places?.find(({ file }) => file === clock.file);
  if (!place) return "";
  if (place.offset === null) return SURE.none;
  const word = SURE[/** @type {keyof typeof SURE} */ (place.confidence)] ?? place.confidence;
  return `${place.offset.toFixed(3)} s, ${word}`;
}
