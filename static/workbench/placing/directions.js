/**
 * Where the arrow keys lead. What Left means depends on the view the annotator looks at: it is the grid
 * direction that comes closest to Left on the screen there, unless the settings say "the axes of the ground". A
 * held key goes on as it began. The helper draws exactly what the keys do.
 */

import { drawArrow } from "../../views/marks.js";
import { YELLOW } from "../../views/styles.js";

const SIGNS = { left: "←", right: "→", up: "↑", down: "↓" };
const LENGTH = 34; // CSS pixels
const REACH = 0.5; // metres along the ground from which an arrow's direction is taken

/** The grid's own directions: for views that cannot tell (behind the camera), and for whoever prefers them. */
const GROUND = {
  left: { columns: -1, rows: 0 },
  right: { columns: 1, rows: 0 },
  up: { columns: 0, rows: 1 },
  down: { columns: 0, rows: -1 },
};

export class Arrows {
  /** @param {{held: import("../keys/key_repeat.js").KeyRepeat}} parts */
  constructor({ panes, settings, held }) {
    Object.assign(this, { _panes: panes, _settings: settings, _held: held });
  }

  /** What each arrow key does to `annotation`: {left: {columns, rows}, right, up, down}. */
  steps(annotation) {
    if (this._held.steps) return this._held.steps;
    if (this._settings.get("arrowAxes") === "ground") return GROUND;
    const seeing = [this._panes.active, ...this._panes.shown].find((pane) => pane.view.box(annotation));
    return seeing?.view.axes(annotation) ?? GROUND;
  }
}

/** Items for `Panes.addExtra`. */
export function directionItems(panes, arrows, pane) {
  const person = panes.people().get(panes.store.selection);
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
      draw: (ctx) => {
        for (const [name, step] of Object.entries(steps)) drawStep(ctx, panes, pane, person, from, name, step);
      },
    },
  ];
}

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

function onPane(pane, ground) {
  const point = pane.view.point(ground);
  return point && pane.transform.toPane(point.x, point.y);
}
