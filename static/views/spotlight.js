/**
 * Shows where on the real screen something is about: a ring around people in every view, an outline around parts
 * of the page, the way to a place. It covers nothing and takes no click.
 * @typedef {import("../truth/annotation.js").Annotation} Annotation
 * @typedef {import("./regions.js").Item} Item
 * @typedef {import("./regions.js").XY} XY
 * @typedef {(annotation: Annotation) => boolean} Concerns
 * @typedef {object} Target
 * @property {number} position where somebody should stand
 * @property {string|null} view id of the only view in which a ring says who is meant; null: none
 * @property {number|null} from position of a box that should be there: an arrow leads on
 * @property {boolean} shown the place itself is shown
 */
import { annotation } from "../truth/annotation.js";
import { drawArrow } from "./marks.js";
import { CYAN, HALO, YELLOW } from "./styles.js";

const AWAY = 7; // CSS pixels between a box and its ring
const [SHORTEST, LONGEST] = [24, 46]; // CSS pixels of an arrow
const RADIUS = 9; // of the ring on a place
const NOBODY = -1; // whoever has no box yet
const CLASS = "in-spotlight";

export class Spotlight {
  /** @param {import("./panes.js").Panes} panes */
  constructor(panes) {
    this._panes = panes;
    /** @type {Concerns} */
    this._concerns = () => false;
    /** @type {Target|null} */
    this._target = null;
    panes.addExtra((pane) => [...this._rings(pane), ...this._way(pane)]);
  }

  /** @param {{parts?: string|null, people?: Concerns, target?: Target|null}} what CSS selector of parts, and who */
  show({ parts = null, people = () => false, target = null }) {
    for (const lit of document.querySelectorAll(`.${CLASS}`)) lit.classList.remove(CLASS);
    if (parts) for (const part of document.querySelectorAll(parts)) part.classList.add(CLASS);
    this._concerns = people;
    this._target = target;
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

  /** @param {import("./pane.js").LaidOutPane} pane @returns {Item[]} */
  _way(pane) {
    if (!this._target) return [];
    const { position, view, from, shown } = this._target;
    const somebody = annotation({ person: NOBODY, position });
    const items = [];
    const { transform } = pane;
    const box = view === pane.view.id ? pane.view.box(somebody) : null;
    if (box) items.push(ringItem(somebody, transform.toPane(box.xmin, box.ymin), transform.toPane(box.xmax, box.ymax)));
    const feet = this._feet(pane, position);
    const start = from === null ? null : this._feet(pane, from);
    if (feet && start) items.push(arrowItem(somebody, start, feet));
    if (feet && shown) items.push(placeItem(somebody, feet));
    return items;
  }

  /** @param {import("./pane.js").LaidOutPane} pane @param {number} position @returns {XY|null} */
  _feet(pane, position) {
    const point = pane.view.point(this._panes.scene.metres(position));
    return point && pane.transform.toPane(point.x, point.y);
  }
}

/** @param {Annotation} one @param {XY} from @param {XY} to @returns {Item} */
function arrowItem(one, from, to) {
  const away = Math.max(Math.hypot(to.x - from.x, to.y - from.y), 1e-6);
  const share = Math.min(Math.max(away, SHORTEST), LONGEST) / away;
  const end = { x: from.x + share * (to.x - from.x), y: from.y + share * (to.y - from.y) };
  return {
    id: "spotlight-arrow",
    what: one,
    look: JSON.stringify([from, end]),
    bounds: around(from, LONGEST + 16),
    draw: (ctx) => drawArrow(ctx, from, end, YELLOW, ""),
  };
}

/** @param {Annotation} one @param {XY} feet @returns {Item} */
function placeItem(one, feet) {
  return {
    id: "spotlight-place",
    what: one,
    look: JSON.stringify(feet),
    bounds: around(feet, RADIUS + 6),
    draw: (ctx) => {
      for (const { colour, line } of [
        { colour: HALO, line: 5 },
        { colour: CYAN, line: 2.5 },
      ]) {
        ctx.strokeStyle = colour;
        ctx.lineWidth = line;
        ctx.setLineDash([5, 4]);
        ctx.beginPath();
        ctx.ellipse(feet.x, feet.y, RADIUS, RADIUS * 0.6, 0, 0, 2 * Math.PI);
        ctx.stroke();
      }
      ctx.setLineDash([]);
    },
  };
}

/** @param {XY} point @param {number} room */
function around({ x, y }, room) {
  return { xmin: x - room, ymin: y - room, xmax: x + room, ymax: y + room };
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
