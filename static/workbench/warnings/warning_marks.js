import { drawPath } from "../../views/marks.js";
import { HALO, INK, YELLOW } from "../../views/styles.js";

/**
 * @typedef {import("../../truth/plausibility.js").Warning} Warning
 * @typedef {import("../../truth/plausibility.js").XY} XY
 * @typedef {import("../../views/pane.js").Pane} Pane
 */

const SIDE = 13; // CSS pixels of the sign
const BELOW = 7; // under the feet, where no box is

/**
 * Items for `Panes.addExtra`: a sign at everybody a warning is about, and on the map where they came from.
 * @param {import("./warnings.js").Warnings} warnings @param {import("../../views/panes.js").Panes} panes @param {Pane} pane
 */
export function warningItems(warnings, panes, pane) {
  return warnings
    .of(panes.store.current)
    .flatMap((warning) =>
      warning.at
        .flatMap((ground) => onPane(pane, ground) ?? [])
        .map((place, index) => item(warning, place, index, comesFrom(pane, warning))),
    );
}

/** @param {Warning} warning @param {XY} place @param {number} index @param {XY|null} from */
function item(warning, place, index, from) {
  const points = from ? [from, place] : [place];
  const [xs, ys] = [points.map(({ x }) => x), points.map(({ y }) => y)];
  return {
    id: `warning ${warning.key} ${index}`,
    what: warning,
    look: "warning",
    bounds: {
      xmin: Math.min(...xs) - SIDE,
      ymin: Math.min(...ys) - 4,
      xmax: Math.max(...xs) + SIDE,
      ymax: Math.max(...ys) + BELOW + SIDE + 4,
    },
    draw: (/** @type {CanvasRenderingContext2D} */ ctx) => {
      if (from) drawPath(ctx, points, { colour: YELLOW, dash: [2, 4] });
      drawSign(ctx, place.x, place.y + BELOW);
    },
  };
}

/**
 * In a view the line would cross half the picture.
 * @param {Pane} pane @param {Warning} warning
 */
function comesFrom(pane, { from }) {
  return from && pane.view.index === null ? onPane(pane, from) : null;
}

/** @param {Pane} pane @param {XY} ground @returns {XY|null} */
function onPane(pane, ground) {
  const point = pane.view.point(ground);
  return point && (pane.transform?.toPane(point.x, point.y) ?? null);
}

/** @param {CanvasRenderingContext2D} ctx @param {number} x @param {number} top */
function drawSign(ctx, x, top) {
  ctx.setLineDash([]);
  ctx.beginPath();
  ctx.moveTo(x, top);
  ctx.lineTo(x + SIDE / 2 + 1, top + SIDE);
  ctx.lineTo(x - SIDE / 2 - 1, top + SIDE);
  ctx.closePath();
  ctx.lineWidth = 2.5;
  ctx.strokeStyle = HALO;
  ctx.stroke();
  ctx.fillStyle = YELLOW;
  ctx.fill();
  ctx.fillStyle = INK;
  ctx.font = "700 10px system-ui, 'DejaVu Sans', sans-serif";
  ctx.textAlign = "center";
  ctx.textBaseline = "alphabetic";
  ctx.fillText("!", x, top + SIDE - 2);
}
