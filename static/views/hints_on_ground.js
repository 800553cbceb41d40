/**
 * Items drawn over the people while placing and moving: readouts, crosses, lines along the ground. CSS pixels.
 * @typedef {import("./regions.js").Item} Item
 * @typedef {import("./regions.js").Size} Size
 * @typedef {import("./regions.js").XY} XY
 */
import { drawPath } from "./marks.js";
import { HALO } from "./styles.js";

const FONT = "600 11px system-ui, 'DejaVu Sans', sans-serif";
const LINE = 15;
const WIDE = 7.6; // of a letter, in the widest of the fonts
const AWAY = 16; // from the pointer: the ground under it stays in sight

/**
 * Lines of text beside a point, inside the pane.
 * @param {string} id @param {Size} room @param {XY} at @param {string[]} lines @param {string} colour @returns {Item}
 */
export function readoutItem(id, room, at, lines, colour) {
  const width = WIDE * Math.max(...lines.map((line) => line.length)) + 12;
  const height = LINE * lines.length + 5;
  const left = at.x + AWAY + width > room.width ? at.x - AWAY - width : at.x + AWAY;
  const top = Math.min(Math.max(at.y + AWAY, 2), room.height - height - 2);
  return {
    id,
    what: lines.join("\n"),
    look: `${colour} ${Math.round(left)} ${Math.round(top)}`,
    bounds: { xmin: left - 1, ymin: top - 1, xmax: left + width + 1, ymax: top + height + 1 },
    draw: (ctx) => {
      ctx.fillStyle = HALO;
      ctx.fillRect(Math.round(left), Math.round(top), Math.round(width), height);
      ctx.font = FONT;
      ctx.textAlign = "left";
      ctx.textBaseline = "middle";
      ctx.fillStyle = colour;
      lines.forEach((line, index) => ctx.fillText(line, Math.round(left) + 6, Math.round(top) + 10.5 + index * LINE));
    },
  };
}

/**
 * A cross where nobody can be put, or where somebody clicked.
 * @param {string} id @param {XY} at @param {string} colour @param {number} [size] @returns {Item}
 */
export function crossItem(id, { x, y }, colour, size = 6) {
  const reach = size + 3;
  return {
    id,
    what: `${x} ${y}`,
    look: colour,
    bounds: { xmin: x - reach, ymin: y - reach, xmax: x + reach, ymax: y + reach },
    draw: (ctx) => {
      drawPath(
        ctx,
        [
          { x: x - size, y: y - size },
          { x: x + size, y: y + size },
        ],
        { colour, width: 1.75 },
      );
      drawPath(
        ctx,
        [
          { x: x - size, y: y + size },
          { x: x + size, y: y - size },
        ],
        { colour, width: 1.75 },
      );
    },
  };
}

/**
 * A thin line through points of the pane.
 * @param {string} id @param {XY[]} points at least one @param {Size} room @param {string} colour @param {number[]} [dash]
 * @returns {Item}
 */
export function lineItem(id, points, room, colour, dash = []) {
  const [first, last] = [points[0], points[points.length - 1]];
  const [xs, ys] = [points.map(({ x }) => x), points.map(({ y }) => y)];
  return {
    id,
    what: `${first.x} ${first.y} ${last.x} ${last.y}`,
    look: colour,
    bounds: {
      xmin: Math.max(Math.min(...xs) - 3, 0),
      ymin: Math.max(Math.min(...ys) - 3, 0),
      xmax: Math.min(Math.max(...xs) + 3, room.width),
      ymax: Math.min(Math.max(...ys) + 3, room.height),
    },
    draw: (ctx) => drawPath(ctx, points, { colour, width: 1, dash }),
  };
}
