/**
 * Drawing in CSS pixels of a pane. Each function only draws; what to draw is decided elsewhere.
 * @typedef {import("./regions.js").XY} XY
 * @typedef {import("./regions.js").Rectangle} Rectangle
 * @typedef {import("./styles.js").Style} Style
 * @typedef {{colour: string, width?: number, dash?: number[], closed?: boolean, rim?: string}} LineStyle
 */
import { HALO, INK, RIM } from "./styles.js";

const LABEL_HEIGHT = 15;
const HANDLE = 5;
/** How far a mark reaches beyond its box: line width, handles, the double line. */
const MARGIN = 9;

/**
 * What draws on a canvas; there is always one where the browser has canvases at all.
 * @param {HTMLCanvasElement} canvas
 */
export function contextOf(canvas) {
  const ctx = canvas.getContext("2d");
  if (!ctx) throw new TypeError("this canvas cannot be drawn on");
  return ctx;
}

/**
 * A person's rectangle with its number above.
 * @param {CanvasRenderingContext2D} ctx @param {Rectangle} box @param {Style} look @param {string} label
 * @param {{box: number, label: number}} [opacity]
 */
export function drawBox(ctx, box, look, label, opacity = { box: 1, label: 1 }) {
  const [x, y] = [box.xmin, box.ymin];
  const [width, height] = [box.xmax - box.xmin, box.ymax - box.ymin];
  ctx.globalAlpha = opacity.box;
  ctx.lineWidth = look.width + 2;
  ctx.strokeStyle = RIM;
  ctx.setLineDash([]);
  ctx.strokeRect(x, y, width, height);
  ctx.lineWidth = look.width;
  ctx.strokeStyle = look.colour;
  ctx.setLineDash(look.dash);
  ctx.strokeRect(x, y, width, height);
  if (look.selected) drawSelection(ctx, x, y, width, height, look);
  ctx.globalAlpha = opacity.label;
  if (label) drawLabel(ctx, x + width / 2, labelBottom(box), label, look);
  ctx.globalAlpha = 1;
}

/**
 * Above the box; inside it where the box reaches out of the pane.
 * @param {Rectangle} box
 */
function labelBottom(box) {
  return Math.max(box.ymin - 3, Math.min(LABEL_HEIGHT + 2, box.ymax));
}

/** @param {string} label */
export function labelWidth(label) {
  return 7 * label.length + 8;
}

/**
 * The number on a small plate, centred over (x, bottom). Selected people have a filled plate.
 * @param {CanvasRenderingContext2D} ctx @param {number} x @param {number} bottom @param {string} label
 * @param {{colour: string, selected: boolean}} look
 */
export function drawLabel(ctx, x, bottom, label, look) {
  const width = labelWidth(label);
  const left = Math.round(x - width / 2);
  const top = Math.round(bottom - LABEL_HEIGHT);
  ctx.fillStyle = look.selected ? look.colour : HALO;
  ctx.fillRect(left, top, width, LABEL_HEIGHT);
  ctx.fillStyle = look.selected ? INK : look.colour;
  ctx.font = "600 11px system-ui, 'DejaVu Sans', sans-serif";
  ctx.textAlign = "center";
  ctx.textBaseline = "middle";
  ctx.fillText(label, left + width / 2, top + LABEL_HEIGHT / 2 + 0.5);
}

/**
 * A ground point as a dot with a dark rim; carried-over people get a ring instead of a filled dot.
 * @param {CanvasRenderingContext2D} ctx @param {number} x @param {number} y
 * @param {{colour: string, dash: number[]}} look @param {number} radius
 */
export function drawFoot(ctx, x, y, look, radius) {
  ctx.setLineDash([]);
  ctx.beginPath();
  ctx.arc(x, y, radius, 0, 2 * Math.PI);
  ctx.lineWidth = 3;
  ctx.strokeStyle = HALO;
  ctx.stroke();
  if (look.dash.length) {
    ctx.lineWidth = 1.5;
    ctx.strokeStyle = look.colour;
    ctx.stroke();
  } else {
    ctx.fillStyle = look.colour;
    ctx.fill();
  }
}

/**
 * A closed or open line through points, light on a dark rim.
 * @param {CanvasRenderingContext2D} ctx @param {XY[]} points @param {LineStyle} style
 */
export function drawPath(ctx, points, { colour, width = 1.25, dash = [], closed = false, rim = HALO }) {
  if (points.length < 2) return;
  ctx.beginPath();
  points.forEach(({ x, y }, index) => (index ? ctx.lineTo(x, y) : ctx.moveTo(x, y)));
  if (closed) ctx.closePath();
  ctx.setLineDash([]);
  ctx.lineWidth = width + 2;
  ctx.strokeStyle = rim;
  ctx.stroke();
  ctx.setLineDash(dash);
  ctx.lineWidth = width;
  ctx.strokeStyle = colour;
  ctx.stroke();
  ctx.setLineDash([]);
}

/**
 * An arrow from one point to another, with a sign at its tip.
 * @param {CanvasRenderingContext2D} ctx @param {XY} from @param {XY} to @param {string} colour @param {string} [sign]
 */
export function drawArrow(ctx, from, to, colour, sign) {
  const angle = Math.atan2(to.y - from.y, to.x - from.x);
  /** @param {number} turn */
  const wing = (turn) => ({ x: to.x - 7 * Math.cos(angle + turn), y: to.y - 7 * Math.sin(angle + turn) });
  drawPath(ctx, [from, to], { colour, width: 2 });
  drawPath(ctx, [wing(0.5), to, wing(-0.5)], { colour, width: 2 });
  if (!sign) return;
  const [x, y] = [to.x + 11 * Math.cos(angle), to.y + 11 * Math.sin(angle)];
  ctx.font = "600 13px system-ui, 'DejaVu Sans', sans-serif";
  ctx.textAlign = "center";
  ctx.textBaseline = "middle";
  ctx.lineWidth = 3;
  ctx.strokeStyle = HALO;
  ctx.strokeText(sign, x, y);
  ctx.fillStyle = colour;
  ctx.fillText(sign, x, y);
}

/**
 * Room a box with its label needs.
 * @param {Rectangle} box @param {string} label @returns {Rectangle}
 */
export function boxBounds(box, label) {
  const half = label ? labelWidth(label) / 2 : 0;
  const middle = (box.xmin + box.xmax) / 2;
  return {
    xmin: Math.min(box.xmin, middle - half) - MARGIN,
    ymin: box.ymin - MARGIN - (label ? LABEL_HEIGHT : 0),
    xmax: Math.max(box.xmax, middle + half) + MARGIN,
    ymax: Math.max(box.ymax, label ? labelBottom(box) : box.ymax) + MARGIN,
  };
}

/** @param {CanvasRenderingContext2D} ctx @param {number} x @param {number} y @param {number} width @param {number} height @param {Style} look */
function drawSelection(ctx, x, y, width, height, look) {
  ctx.setLineDash([]);
  ctx.lineWidth = 1;
  ctx.strokeStyle = look.colour;
  ctx.strokeRect(x - 4, y - 4, width + 8, height + 8);
  ctx.fillStyle = look.colour;
  for (const [handleX, handleY] of [
    [x, y],
    [x + width, y],
    [x, y + height],
    [x + width, y + height],
  ]) {
    ctx.fillRect(handleX - HANDLE / 2, handleY - HANDLE / 2, HANDLE, HANDLE);
  }
}
