import { svg } from "../base/svg.js";

const ACROSS = 40; // pixels of the picture that are seen

/** @typedef {import("./picture.js").XY} XY */

/** A few pixels around a place, large, with a cross hair in the middle. */
export class Magnifier {
  constructor() {
    this._image = svg("image", { x: -0.5, y: -0.5, preserveAspectRatio: "none", class: "pixels" });
    this._cross = svg("path", { class: "hair" });
    this.element = svg("svg", { class: "magnifier", role: "img", "aria-label": "Magnifier" }, this._image, this._cross);
  }

  /** @param {{href: string, width: number, height: number}|null} shown */
  show(shown) {
    for (const [name, value] of Object.entries(shown ?? { href: "", width: 0, height: 0 }))
      this._image.setAttribute(name, String(value));
  }

  /** @param {XY|null} place */
  at(place) {
    this.element.classList.toggle("empty", !place);
    if (!place) return;
    const { x, y } = place;
    const half = ACROSS / 2;
    this.element.setAttribute("viewBox", `${x - half} ${y - half} ${ACROSS} ${ACROSS}`);
    const gap = 1.2;
    const lines = [
      `M${x - half} ${y}H${x - gap}M${x + gap} ${y}H${x + half}`,
      `M${x} ${y - half}V${y - gap}M${x} ${y + gap}V${y + half}`,
    ];
    this._cross.setAttribute("d", lines.join(""));
  }
}
