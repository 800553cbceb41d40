import { Emitter } from "../base/emitter.js";
import { svg } from "../base/svg.js";

const DRAGGED = 4; // CSS pixels from which a press is a drag
const STEP = 1.0015; // zoom per unit of the wheel
const CLOSEST = 12; // pixels of the picture across, at the closest

/**
 * @typedef {{x: number, y: number}} XY pixels of the picture; the centre of the upper left one is 0, 0
 * @typedef {{href: string, width: number, height: number}} Shown
 * @typedef {{click: XY, hover: XY|null, view: null}} PictureEvents
 */

/**
 * A picture to look at closely: wheel zooms, dragging moves, a click tells its pixel. What is drawn into `marks`
 * is in pixels of the picture; `unit` says how many of them are one CSS pixel now.
 * @extends {Emitter<PictureEvents>}
 */
export class Picture extends Emitter {
  /** @param {string} label for screen readers */
  constructor(label) {
    super();
    this._image = svg("image", { x: -0.5, y: -0.5, preserveAspectRatio: "none" });
    this.marks = svg("g");
    this.element = svg("svg", { class: "desk-picture", "aria-label": label, role: "img" }, this._image, this.marks);
    this.size = { width: 0, height: 0 };
    this._box = [0, 0, 1, 1];
    this._listen();
  }

  /** @param {Shown|null} shown */
  show(shown) {
    const { width, height } = shown ?? { width: 0, height: 0 };
    const same = width === this.size.width && height === this.size.height;
    this.size = { width, height };
    for (const [name, value] of Object.entries({ width, height, href: shown?.href ?? "" }))
      this._image.setAttribute(name, String(value));
    if (!same || !shown) this.fit();
  }

  fit() {
    this._look([-0.5, -0.5, Math.max(this.size.width, 1), Math.max(this.size.height, 1)]);
  }

  /** Bring a pixel to the middle; `across`: how much of the picture is seen, unless it is close enough. @param {XY} place @param {number} across */
  lookAt({ x, y }, across) {
    const width = Math.min(this._box[2], across);
    const height = (width * this.size.height) / this.size.width;
    this._look([x - width / 2, y - height / 2, width, height]);
  }

  /** Pixels of the picture that are one CSS pixel. */
  get unit() {
    const scale = this.element instanceof SVGSVGElement ? (this.element.getScreenCTM()?.a ?? 1) : 1;
    return 1 / scale;
  }

  /** @param {MouseEvent} event @returns {XY} */
  pixel({ clientX, clientY }) {
    const matrix = this.element instanceof SVGSVGElement ? this.element.getScreenCTM() : null;
    const { x, y } = new DOMPoint(clientX, clientY).matrixTransform(matrix?.inverse());
    return { x, y };
  }

  /** @param {number[]} box */
  _look(box) {
    this._box = box;
    this.element.setAttribute("viewBox", box.join(" "));
    this.emit("view", null);
  }

  /** @param {number} factor @param {XY} at */
  _zoom(factor, at) {
    const [left, top, width, height] = this._box;
    if (width * factor > 1.02 * this.size.width) return this.fit();
    const wanted = Math.max(width * factor, CLOSEST) / width;
    this._look([at.x - (at.x - left) * wanted, at.y - (at.y - top) * wanted, width * wanted, height * wanted]);
  }

  _listen() {
    /** @type {{x: number, y: number, box: number[], dragged: boolean}|null} */
    let press = null;
    const node = /** @type {SVGSVGElement} */ (this.element);
    node.addEventListener("wheel", (event) => {
      event.preventDefault();
      this._zoom(STEP ** event.deltaY, this.pixel(event));
    });
    node.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      press = { x: event.clientX, y: event.clientY, box: this._box, dragged: false };
      node.setPointerCapture(event.pointerId);
    });
    node.addEventListener("pointermove", (event) => {
      this.emit("hover", this.pixel(event));
      if (!press) return;
      const [dx, dy] = [event.clientX - press.x, event.clientY - press.y];
      press.dragged ||= Math.hypot(dx, dy) > DRAGGED;
      const [left, top, width, height] = press.box;
      if (press.dragged) this._look([left - dx * this.unit, top - dy * this.unit, width, height]);
    });
    node.addEventListener("pointerup", (event) => {
      if (press && !press.dragged) this.emit("click", this.pixel(event));
      press = null;
    });
    node.addEventListener("pointercancel", () => (press = null));
    node.addEventListener("pointerleave", () => this.emit("hover", null));
  }
}
