/**
 * The ground as a camera sees it: its outline and lines in the picture, and the picture's outline on it.
 * @typedef {import("./camera.js").Camera} Camera
 * @typedef {import("./camera.js").AnyCamera} AnyCamera
 * @typedef {import("./grid.js").Grid} Grid
 * @typedef {import("./lens.js").XY} XY
 */
import { Point } from "./lens.js";

const NEAREST = 0.05; // metres before the camera plane where lines are cut
const AROUND = 1; // picture widths and heights around the picture that lines are still drawn in
const PIECES = 64; // a line the lens bends is drawn in so many pieces
const BORDER_PIECES = 48; // per side of a picture whose border the lens bends
const HORIZON_MARGIN = 1e-4; // slope of the flattest ray that counts as meeting the ground

/**
 * Outline of the grid in a view.
 *
 * @param {AnyCamera} camera @param {Grid} grid
 * @returns {XY[][]} polylines, only those parts that are in front of the camera
 */
export function gridOutline(camera, grid) {
  const { left, right, near, far } = sides(grid);
  const corners = [
    [left, near],
    [right, near],
    [right, far],
    [left, far],
  ];
  return corners.flatMap(([x, y], index) => {
    const [nextX, nextY] = corners[(index + 1) % 4];
    return groundLine(camera, x, y, nextX, nextY);
  });
}

/**
 * Lines on the ground at whole multiples of `spacing` metres inside the grid.
 *
 * @param {AnyCamera} camera @param {Grid} grid @param {number} [spacing]
 * @returns {XY[][]} polylines in the view
 */
export function gridLines(camera, grid, spacing = 1) {
  const { left, right, near, far } = sides(grid);
  const along = multiples(left, right, spacing).flatMap((x) => groundLine(camera, x, near, x, far));
  const across = multiples(near, far, spacing).flatMap((y) => groundLine(camera, left, y, right, y));
  return [...along, ...across];
}

/**
 * The straight line between two ground points in a view, cut at the camera plane and well outside the picture.
 *
 * @param {AnyCamera} camera @param {number} x1 @param {number} y1 @param {number} x2 @param {number} y2
 * @returns {XY[][]} no polyline, one, or several where the lens model ends in between
 */
export function groundLine(camera, x1, y1, x2, y2) {
  if (camera.byTable) return camera.line(x1, y1, x2, y2);
  const from = camera.seen(x1, y1, 0).map((value) => value * camera.facing);
  const to = camera.seen(x2, y2, 0).map((value) => value * camera.facing);
  const interval = visibleInterval(camera, from, to);
  if (!interval) return [];
  const pieces = camera.lens ? PIECES : 1;
  /** @type {XY[]} */
  let line = [];
  const lines = [line];
  for (let piece = 0; piece <= pieces; piece += 1) {
    const share = interval[0] + ((interval[1] - interval[0]) * piece) / pieces;
    const [x, y, depth] = from.map((value, axis) => value + (to[axis] - value) * share);
    if (camera.lens && !(Math.hypot(x, y) / depth < camera.lens.limit)) {
      line = [];
      lines.push(line);
    } else {
      const { x: u, y: v } = camera.pixel(x / depth, y / depth, new Point());
      line.push({ x: u, y: v });
    }
  }
  return lines.filter(({ length }) => length > 1);
}

/**
 * Corners of the ground inside the picture, clipped to the grid; empty when the camera sees nothing of it.
 *
 * @param {AnyCamera} camera @param {Grid} grid
 * @returns {XY[]} metres
 */
export function footprint(camera, grid) {
  if (camera.byTable) return camera.outline();
  const [cx, cy, height] = camera.centre;
  // On the way to the ground a ray loses the camera's height: the ray's z has the other sign.
  const sign = camera.facing * (height > 0 ? -1 : 1);
  const rays = border(camera).map(({ x, y }) => camera.ray(x, y).map((value) => value * sign));
  const { left, right, near, far } = sides(grid);
  let polygon = clip(rays, (ray) => ray[2] - HORIZON_MARGIN).map((ray) => {
    const reach = -height / ray[2];
    return [cx + reach * ray[0], cy + reach * ray[1]];
  });
  /** @type {((corner: number[]) => number)[]} */
  const borders = [([x]) => x - left, ([x]) => right - x, ([, y]) => y - near, ([, y]) => far - y];
  for (const inside of borders) {
    polygon = clip(polygon, inside);
  }
  return polygon.map(([x, y]) => ({ x, y }));
}

/** @param {Grid} grid */
function sides({ origin, extent }) {
  return { left: origin[0], right: origin[0] + extent[0], near: origin[1], far: origin[1] + extent[1] };
}

/** @param {number} low @param {number} high @param {number} spacing */
function multiples(low, high, spacing) {
  const first = Math.ceil(low / spacing - 1e-9);
  const last = Math.floor(high / spacing + 1e-9);
  return Array.from({ length: Math.max(last - first + 1, 0) }, (_, index) => (first + index) * spacing);
}

/**
 * The part of a line between two points in camera axes that is worth drawing: shares [from, to], or null.
 * @param {Camera} camera @param {number[]} from @param {number[]} to
 */
function visibleInterval(camera, from, to) {
  const { fx, fy, cx, cy, width, height } = camera;
  /** @type {((place: number[]) => number)[]} */
  const bounds = [
    ([, , z]) => z - NEAREST,
    ([x, , z]) => x + ((cx + AROUND * width) / fx) * z,
    ([x, , z]) => (((1 + AROUND) * width - cx) / fx) * z - x,
    ([, y, z]) => y + ((cy + AROUND * height) / fy) * z,
    ([, y, z]) => (((1 + AROUND) * height - cy) / fy) * z - y,
  ];
  let [start, end] = [0, 1];
  for (const inside of bounds) {
    const [here, there] = [inside(from), inside(to)];
    if (here < 0 && there < 0) return null;
    if (here < 0) start = Math.max(start, here / (here - there));
    if (there < 0) end = Math.min(end, here / (here - there));
  }
  return start < end ? [start, end] : null;
}

/**
 * The picture's border as directions without the lens.
 * @param {Camera} camera
 */
function border(camera) {
  const [right, bottom] = [camera.width - 0.5, camera.height - 0.5];
  const corners = [
    [-0.5, -0.5],
    [right, -0.5],
    [right, bottom],
    [-0.5, bottom],
  ];
  const pieces = camera.lens ? BORDER_PIECES : 1;
  /** @type {XY[]} */
  const directions = [];
  corners.forEach(([u, v], index) => {
    const [nextU, nextV] = corners[(index + 1) % 4];
    for (let piece = 0; piece < pieces; piece += 1) {
      const share = piece / pieces;
      const direction = new Point();
      if (camera.normalise(u + (nextU - u) * share, v + (nextV - v) * share, direction)) directions.push(direction);
    }
  });
  return directions;
}

/**
 * The part of a polygon where `inside`, a linear function of its corners, is not negative.
 * @param {number[][]} polygon @param {(corner: number[]) => number} inside
 */
function clip(polygon, inside) {
  return polygon.flatMap((corner, index) => {
    const other = polygon[(index + 1) % polygon.length];
    const [here, there] = [inside(corner), inside(other)];
    const kept = here >= 0 ? [corner] : [];
    if (here >= 0 !== there >= 0) {
      kept.push(corner.map((value, axis) => value + (other[axis] - value) * (here / (here - there))));
    }
    return kept;
  });
}
