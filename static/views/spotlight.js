/**
 * Shows where on the real screen something is about: a ring around people in every view, an outline around parts
 * of the page. It covers nothing and takes no click.
 * @typedef {import("../truth/annotation.js").Annotation} Annotation
 * @typedef {import("./regions.js").Item} Item
 * @typedef {import("./regions.js").XY} XY
 * @typedef {(annotation: Annotation) => boolean} Concerns
 */
import { CYAN, HALO } from "./styles.js";

const AWAY = 7; // CSS pixels between a box and its ring
const CLASS = "in-spotlight";

export class Spotlight {
  /** @param {import("./panes.js").Panes} panes */
  constructor(panes) {
    this._panes = panes;
    /** @type {Concerns} */
    this._concerns = () => false;
    panes.addExtra((pane) => this._rings(pane));
  }

  /** @param {{parts?: string|null, people?: Concerns}} what CSS selector of parts, and who */
  show({ parts = null, people = () => false }) {
    for (const lit of document.querySelectorAll(`.${CLASS}`)) lit.classList.remove(CLASS);
    if (parts) for (const part of document.querySelectorAll(parts)) part.classList.add(CLASS);
    this._concerns = people;
    this._panes.markPeople();
  }

  /** @param {import("./pane.js").LaidOutPane} pane @returns {Item[]} */
  _rings(pane) {
    return [...this._panes.people().values()].filter(this._concerns).flatMap((one) => {
      const box = pane.view.box(one);
      return box
        ? [ringItem(one, pane.transform.toPane(box.xmin, box.ymin), pane.transform.toPane(box.xmax, box.ymax))]
        : [];
    });
  }
}

/** @param {Annotation} one @param {XY} low @param {XY} high @returns {Item} */
function ringItem(one, low, high) {
  const [left, top] = [low.x - AWAY, low.y - AWAY];
  const [width, height] = [high.x - low.x + 2 * AWAY, high.y - low.y + 2 * AWAY];
  return {
    id: `spotlight-${one.person}`,
    what: one,
    look: "spotlight",
    bounds: { xmin: left - 4, ymin: top - 4, xmax: left + width + 4, ymax: top + height + 4 },
    draw: (ctx) => {
      ctx.setLineDash([]);
      for (const { colour, line } of [
        { colour: HALO, line: 5 },
        { colour: CYAN, line: 2.5 },
      ]) {
        ctx.strokeStyle = colour;
        ctx.lineWidth = line;
        ctx.beginPath();
        ctx.roundRect(left, top, width, height, 9);
        ctx.stroke();
      }
    },
  };
}
