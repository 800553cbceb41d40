import { project } from "../../geometry/camera.js";

const PIECE = 0.25; // metres: a lens bends lines
const MOST_LINES = 60; // a direction
const STEPS = [0.25, 0.5, 1, 2, 5, 10, 20, 50, 100]; // metres between lines

/**
 * @typedef {import("./store.js").Point} Point
 * @typedef {import("../../geometry/camera.js").Camera} Camera
 */

/**
 * Lines on the ground around the measured points, as they are seen: lists of pixels "x,y x,y …", and the metres
 * between two lines.
 * @param {Camera} camera @param {Point[]} points
 * @returns {{lines: string[], step: number}}
 */
export function gridLines(camera, points) {
  const [xs, ys] = [points.map(({ x }) => x), points.map(({ y }) => y)];
  const across = Math.max(Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys), 1);
  const step = STEPS.find((each) => across / each <= 20) ?? across / 20;
  const [x0, x1] = bounds(xs, step);
  const [y0, y1] = bounds(ys, step);
  const lines = [];
  for (const x of rule(x0, x1, step)) lines.push(...line(camera, [x, y0], [x, y1]));
  for (const y of rule(y0, y1, step)) lines.push(...line(camera, [x0, y], [x1, y]));
  return { lines, step };
}

/** One line beyond the outermost points. @param {number[]} values @param {number} step */
function bounds(values, step) {
  return [(Math.floor(Math.min(...values) / step) - 1) * step, (Math.ceil(Math.max(...values) / step) + 1) * step];
}

/** @param {number} first @param {number} last @param {number} step */
function rule(first, last, step) {
  const count = Math.min(Math.round((last - first) / step) + 1, MOST_LINES);
  return Array.from({ length: count }, (_, index) => first + index * step);
}

/** The parts of a line that are seen. @param {Camera} camera @param {number[]} from @param {number[]} to */
function line(camera, [x0, y0], [x1, y1]) {
  const pieces = Math.max(Math.round(Math.hypot(x1 - x0, y1 - y0) / PIECE), 1);
  /** @type {string[][]} */
  const parts = [[]];
  for (let piece = 0; piece <= pieces; piece += 1) {
    const share = piece / pieces;
    const seen = project(camera, x0 + share * (x1 - x0), y0 + share * (y1 - y0));
    const near = seen && seen.x > -camera.width && seen.x < 2 * camera.width && Math.abs(seen.y) < 3 * camera.height;
    if (near) parts.at(-1)?.push(`${seen.x.toFixed(1)},${seen.y.toFixed(1)}`);
    else if (parts.at(-1)?.length) parts.push([]);
  }
  return parts.filter((part) => part.length > 1).map((part) => part.join(" "));
}
