import { element, setText } from "../../base/dom.js";
import { Emitter } from "../../base/emitter.js";
import { Picture } from "../picture.js";
import { marks } from "./marks.js";
import { seenIn } from "./seen.js";

const CLOSE = 60; // pixels of the picture across, at least, when one looks closely
const AROUND = 12; // times the ± of the place

/**
 * @typedef {import("./store.js").Store} Store
 * @typedef {import("./store.js").CheckCamera} CheckCamera
 * @typedef {import("./seen.js").Seen} Seen
 * @typedef {import("../picture.js").XY} XY
 * @typedef {{click: XY, hover: XY|null, view: null}} PaneEvents
 */

/**
 * One camera's picture with what it shows of the thing, or what the camera lacks.
 * @extends {Emitter<PaneEvents>}
 */
export class Pane extends Emitter {
  /** @param {CheckCamera} camera @param {string} href of its picture; empty: none @param {string} desk address of the desk's pages */
  constructor(camera, href, desk) {
    super();
    this.camera = camera;
    this.shown = href ? { href, width: camera.width, height: camera.height } : null;
    this.picture = new Picture(`What ${camera.name} sees`);
    this.picture.show(this.shown);
    this._words = element("span", { className: "words" });
    const caption = element("figcaption", {}, element("b", {}, camera.name), this._words);
    this._lack = element("p", { className: "empty-view" });
    this._desk = desk;
    this.element = element("figure", { className: "pane", "data-camera": camera.name }, caption, this._lack);
    this.element.append(this.picture.element);
    this.picture.on("click", (place) => this.emit("click", place));
    this.picture.on("hover", (place) => this.emit("hover", place));
    this.picture.on("view", () => this.emit("view", null));
  }

  /** @param {Store} store @param {boolean} active @param {boolean} lines */
  draw(store, active, lines) {
    const seen = seenIn(store, this.camera.name);
    const calibrated = store.cameras.has(this.camera.name);
    this.element.classList.toggle("active", active);
    this.element.classList.toggle("lacking", !calibrated || !this.shown);
    this.element.classList.toggle("doubtful", seen.doubtful);
    this.picture.marks.replaceChildren(...marks(seen, this.camera, this.picture.unit, lines));
    setText(this._words, calibrated ? words(seen, store) : "");
    this._drawLack(store.against, calibrated);
  }

  /** Where the magnifier looks when the pointer is elsewhere. @param {Store} store @returns {XY|null} */
  place(store) {
    const { click, place, inside } = seenIn(store, this.camera.name);
    return click ?? (inside ? place : null);
  }

  /** @param {Store} store */
  closer(store) {
    const { click, place, ellipse } = seenIn(store, this.camera.name);
    const at = place ?? click;
    if (at) this.picture.lookAt(at, Math.max(CLOSE, this.camera.width / 8, AROUND * (ellipse?.major ?? 0)));
  }

  /** @param {string} against @param {boolean} calibrated */
  _drawLack(against, calibrated) {
    const { lacks } = this.camera;
    const words = calibrated ? (this.shown ? "" : "It has no picture yet.") : lackWords(against, lacks);
    this._lack.hidden = !words;
    if (this._lack.dataset.words === words) return;
    this._lack.dataset.words = words;
    const page = calibrated ? "ground" : against === "placed" ? lacks?.page : "";
    const link = element("a", { href: address(this._desk, page ?? "", this.camera.name) }, `${words} Go there`);
    this._lack.replaceChildren(page ? link : words);
  }
}

/** @param {string} against @param {import("./store.js").Lack|null} lacks */
function lackWords(against, lacks) {
  if (against === "in_place") return "The dataset has no such camera that can be checked.";
  return lacks?.words ?? "It has no calibration yet.";
}

/** @param {string} desk @param {string} page @param {string} camera */
function address(desk, page, camera) {
  const name = encodeURIComponent(camera);
  return page === "lens" ? `${desk}lens/${name}/` : `${desk}ground/?camera=${name}`;
}

/** @param {Seen} seen @param {Store} store */
function words({ click, residual, doubtful, place, inside, lines }, { figures, clicks }) {
  if (residual !== null) return `${residual.toFixed(1)} px${doubtful ? " off: look again" : ""}`;
  if (figures.spot) return place && inside ? "expected at the cross" : "not in this picture";
  if (click) return "clicked";
  if (Object.keys(clicks).length === 0) return "";
  return lines.length ? "somewhere on the line" : "not in this picture";
}
