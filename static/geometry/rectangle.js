/**
 * The rule that turns a cylinder into a rectangle.
 *
 * gtm_hit/geometry/rectangle_rule.py has the same rule for blocks of ground: the precision, the order of
 * operations and the place of every truncation are part of it, and results are identical. Change both or neither.
 *
 * @typedef {import("./camera.js").Camera} Camera
 * @typedef {import("./grid.js").Grid} Grid
 * @typedef {{radius: number, height: number}} Cylinder metres
 * @typedef {"corners"|"centre"} FootRule of a dataset
 * @typedef {{xmin: number, ymin: number, xmax: number, ymax: number}} Rectangle pixels
 */
import { Point } from "./lens.js";

const [LOWEST, HIGHEST] = [-32768, 32767]; // files and tables hold int16

// Scratch space: a rectangle is computed for every position people pass, so nothing is allocated on the way.
const pixel = new Point();
const sidesX = new Float64Array(2);
const sidesY = new Float64Array(2);
const u = new Float64Array(8);
const v = new Float64Array(8);
const box = new Float64Array(4);

/**
 * Rectangle of a cylinder standing on a position, never clipped to the image; null where not visible.
 *
 * @param {Camera} camera @param {Grid} grid @param {Cylinder} cylinder @param {FootRule} rule
 * @param {number} position
 * @returns {Rectangle|null}
 */
export function rectangle(camera, grid, cylinder, rule, position) {
  if (!rectangleInto(box, camera, grid, cylinder, rule, position)) return null;
  return { xmin: box[0], ymin: box[1], xmax: box[2], ymax: box[3] };
}

/**
 * The rectangle that a camera's table has for a position: what the rule gives for the usual person.
 * @param {Int16Array} boxes @param {number} position @returns {Rectangle|null}
 */
export function rectangleIn(boxes, position) {
  const at = 4 * position;
  if (!(boxes[at + 2] > 0)) return null;
  return { xmin: boxes[at], ymin: boxes[at + 1], xmax: boxes[at + 2], ymax: boxes[at + 3] };
}

/**
 * What `rectangle` gives into `out` (xmin, ymin, xmax, ymax), without allocating; false, and `out` unspecified, if not visible.
 * @param {Float64Array} out @param {Camera} camera @param {Grid} grid @param {Cylinder} cylinder
 * @param {FootRule} rule @param {number} position
 */
export function rectangleInto(out, camera, grid, cylinder, rule, position) {
  if (rule === "corners") return cornersRule(out, camera, grid, cylinder, position);
  if (rule === "centre") return centreRule(out, camera, grid, cylinder, position);
  throw new TypeError(`foot rule must be "corners" or "centre", not ${rule}`);
}

/**
 * WILDTRACK's: float32, truncated corner by corner, foot = mean of the four lowest corners.
 * @param {Float64Array} out @param {Camera} camera @param {Grid} grid @param {Cylinder} cylinder
 * @param {number} position
 */
function cornersRule(out, camera, grid, cylinder, position) {
  const f = Math.fround;
  const row = Math.floor(position / grid.columns);
  const column = position - row * grid.columns;
  const x = f(f(grid.origin[0]) + f(f(f(column) * f(grid.extent[0])) / f(grid.columns)));
  const y = f(f(grid.origin[1]) + f(f(f(row) * f(grid.extent[1])) / f(grid.rows)));
  const radius = f(cylinder.radius);
  const height = f(cylinder.height);
  setSides(f(x - radius), f(x + radius), f(y - radius), f(y + radius));
  if (!inFront(camera, x, y, height)) return false;
  projectCorners(camera, height);
  for (let corner = 0; corner < 8; corner += 1) {
    u[corner] = Math.trunc(f(u[corner])) + 0; // + 0: never -0
    v[corner] = Math.trunc(f(v[corner])) + 0;
  }
  sortEight(v);
  out[0] = smallest(u);
  out[1] = v[0];
  out[2] = largest(u);
  out[3] = Math.floor((v[4] + v[5] + v[6] + v[7]) / 4);
  return acceptable(out, camera) && out[2] - out[0] <= Math.floor(camera.width / 3);
}

/**
 * MultiviewX's: float64, truncated last, foot = the projected ground centre.
 * @param {Float64Array} out @param {Camera} camera @param {Grid} grid @param {Cylinder} cylinder
 * @param {number} position
 */
function centreRule(out, camera, grid, cylinder, position) {
  const row = Math.floor(position / grid.columns);
  const column = position - row * grid.columns;
  const x = grid.origin[0] + (column * grid.extent[0]) / grid.columns;
  const y = grid.origin[1] + (row * grid.extent[1]) / grid.rows;
  const { radius, height } = cylinder;
  setSides(x - radius, x + radius, y - radius, y + radius);
  if (!inFront(camera, x, y, height)) return false;
  projectCorners(camera, height);
  out[0] = smallest(u);
  out[1] = smallest(v);
  out[2] = largest(u);
  out[3] = axisHeight(camera, x, y, 0);
  if (!(out[2] - out[0] <= camera.width / 3 && out[3] - out[1] <= camera.height / 3)) return false;
  if (!acceptable(out, camera)) return false;
  for (let side = 0; side < 4; side += 1) out[side] = Math.trunc(out[side]) + 0;
  return true;
}

/** @param {number} lowX @param {number} highX @param {number} lowY @param {number} highY */
function setSides(lowX, highX, lowY, highY) {
  sidesX[0] = lowX;
  sidesX[1] = highX;
  sidesY[0] = lowY;
  sidesY[1] = highY;
}

/**
 * Pixels of the four feet corners, then of the four heads, into `u` and `v`.
 * @param {Camera} camera @param {number} height
 */
function projectCorners(camera, height) {
  for (let corner = 0; corner < 8; corner += 1) {
    toPixel(camera, sidesX[corner & 1], sidesY[(corner >> 1) & 1], corner < 4 ? 0 : height);
    u[corner] = pixel.x;
    v[corner] = pixel.y;
  }
}

/**
 * Pixel of a world point, into `pixel`; the sums are made axis by axis, as on a grid.
 * @param {Camera} camera @param {number} x @param {number} y @param {number} z
 */
function toPixel(camera, x, y, z) {
  const m = camera.terms;
  const t = camera.offset;
  const inverse = 1 / (m[6] * x + (m[7] * y + t[2]) + m[8] * z);
  const right = (m[0] * x + (m[1] * y + t[0]) + m[2] * z) * inverse;
  const down = (m[3] * x + (m[4] * y + t[1]) + m[5] * z) * inverse;
  if (camera.lens) {
    camera.pixel(right, down, pixel);
  } else {
    pixel.x = right + camera.cx;
    pixel.y = down + camera.cy;
  }
}

/** @param {Camera} camera @param {number} x @param {number} y @param {number} z */
function axisHeight(camera, x, y, z) {
  toPixel(camera, x, y, z);
  return pixel.y;
}

/**
 * All eight corners on one side of the camera plane, and the head above the feet.
 * @param {Camera} camera @param {number} x @param {number} y @param {number} height
 */
function inFront(camera, x, y, height) {
  const m = camera.terms;
  const offset = camera.offset[2];
  const low = m[6] * sidesX[0];
  const high = m[6] * sidesX[1];
  const near = m[7] * sidesY[0] + offset;
  const far = m[7] * sidesY[1] + offset;
  const rise = m[8] * height;
  const nearest = Math.min(low, high) + Math.min(near, far);
  const farthest = Math.max(low, high) + Math.max(near, far);
  if (!(nearest + Math.min(rise, 0) > 0 || farthest + Math.max(rise, 0) < 0)) return false;
  return axisHeight(camera, x, y, height) < axisHeight(camera, x, y, 0);
}

/**
 * The tests both foot rules share.
 * @param {Float64Array} sides @param {Camera} camera
 */
function acceptable(sides, camera) {
  const xmin = sides[0];
  const ymin = sides[1];
  const xmax = sides[2];
  const ymax = sides[3];
  const inside = xmin < camera.width - 2 && ymin < camera.height - 2 && xmax > 1 && ymax > 1;
  const fits = xmin > LOWEST - 1 && ymin > LOWEST - 1 && xmax < HIGHEST + 1 && ymax < HIGHEST + 1;
  return inside && fits && xmax - xmin <= ymax - ymin;
}

/** @param {Float64Array} values */
function smallest(values) {
  let found = values[0];
  for (let index = 1; index < 8; index += 1) found = Math.min(found, values[index]);
  return found;
}

/** @param {Float64Array} values */
function largest(values) {
  let found = values[0];
  for (let index = 1; index < 8; index += 1) found = Math.max(found, values[index]);
  return found;
}

/**
 * Insertion sort, ascending: heads mostly lie above feet already.
 * @param {Float64Array} values
 */
function sortEight(values) {
  for (let index = 1; index < 8; index += 1) {
    const value = values[index];
    let place = index;
    for (; place > 0 && values[place - 1] > value; place -= 1) values[place] = values[place - 1];
    values[place] = value;
  }
}
