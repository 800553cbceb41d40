/**
 * Where the arrow keys lead. What Left means depends on the view the annotator looks at: it is the grid
 * direction that comes closest to Left on the screen there, unless the settings say "the axes of the ground". A
 * held key goes on as it began. The helper draws exactly what the keys do.
 * @typedef {import("../../geometry/directions.js").Step} Step
 * @typedef {import("../../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../../truth/ground_point.js").XY} XY
 * @typedef {import("../../views/pane.js").Pane} Pane
 * @typedef {import("../../views/panes.js").Panes} Panes
 * @typedef {"left"|"right"|"up"|"down"} Direction
 * @typedef {Record<Direction, Step>} Steps what each arrow key does
 */

import { drawArrow } from "../../views/marks.js";
import { YELLOW } from "../../views/styles.js";

/** @type {readonly Direction[]} */
export const DIRECTIONS = ["left", "right", "up", "down"];
/** @type {Record<Direction, string>} */
const SIGNS = { left: "←", right: "→", up: "↑", down: "↓" };
const LENGTH = 34; // CSS pixels
const REACH = 0.5; // metres along the ground from which an arrow's direction is taken

/**
 * The grid's own directions: for views that cannot tell (behind the camera), and for whoever prefers them.
 * @type {Steps}
 */
const GROUND = {
  left: { columns: -1, rows: 0 },
  right: { columns: 1, rows: 0 },
  up: { columns: 0, rows: 1 },
  down: { columns: 0, rows: -1 },
};

export class Arrows {
  /**
   * @param {object} parts
   * @param {Panes} parts.panes
   * @param {import("../settings.js").Settings} parts.settings
   * @param {import("../keys/key_repeat.js").KeyRepeat} parts.held
   */
  constructor({ panes, settings, held }) {
    this._panes = panes;
    this._settings = settings;
    this._held = held;
  }

  /**
   * What each arrow key does to `annotation`.
   * @param {Annotation} annotation @returns {Steps}
   */
  steps(annotation) {
    if (this._held.steps) return this._held.steps;
    if (this._settings.get("arrowAxes") === "ground") return GROUND;
    const seeing = [this._panes.active, ...this._panes.shown].find((pane) => pane.view.box(annotation));
    return seeing?.view.axes(annotation) ?? GROUND;
  }
}

/**
 * Items for `Panes.addExtra`.
 * @param {Panes} panes @param {Arrows} arrows @param {Pane} pane
 */
export function directionItems(panes, arrows, pane) {
  const { selection } = panes.store;
  const person = selection === null ? undefined : panes.people().get(selection);
  if (!panes.options.directions || !person || !pane.view.box(person)) return [];
  const steps = arrows.steps(person);
  const from = onPane(pane, panes.scene.metres(person.position));
  if (!from) return [];
  const room = LENGTH + 26;
  return [
    {
      id: "directions",
      what: person,
      look: JSON.stringify(steps),
      bounds: { xmin: from.x - room, ymin: from.y - room, xmax: from.x + room, ymax: from.y + room },
      /** @param {CanvasRenderingContext2D} ctx */
      draw: (ctx) => {
        for (const name of DIRECTIONS) drawStep(ctx, panes, pane, person, from, name, steps[name]);
      },
    },
  ];
}

/**
 * @param {CanvasRenderingContext2D} ctx @param {Panes} panes @param {Pane} pane @param {Annotation} person
 * @param {XY} from CSS pixels of the pane @param {Direction} name @param {Step} step
 */
function drawStep(ctx, panes, pane, person, from, name, { columns, rows }) {
  const { x, y } = panes.scene.metres(person.position);
  const to = onPane(pane, { x: x + columns * REACH, y: y + rows * REACH });
  if (!to) return;
  const length = Math.hypot(to.x - from.x, to.y - from.y);
  if (length < 1e-6) return;
  const [dx, dy] = [(to.x - from.x) / length, (to.y - from.y) / length];
  const start = { x: from.x + 8 * dx, y: from.y + 8 * dy };
  drawArrow(ctx, start, { x: from.x + LENGTH * dx, y: from.y + LENGTH * dy }, YELLOW, SIGNS[name]);
}

/** @param {Pane} pane @param {XY} ground metres @returns {XY|null} CSS pixels of the pane */
function onPane(pane, ground) {
  const point = pane.view.point(ground);
  return point && pane.transform ? pane.transform.toPane(point.x, point.y) : null;
}
