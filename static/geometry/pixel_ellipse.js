import { shown } from "./spatial.js";

const SMALL = 1e-4; // metres

/** @typedef {{major: number, minor: number, turn: number}} Ellipse half axes in pixels; degrees from x towards y */

/**
 * ± one σ of a world point as a camera sees it; null where it does not.
 * @param {import("./camera.js").Camera} camera @param {number[]} point metres @param {number[][]} covariance 3×3, metres²
 * @returns {Ellipse|null}
 */
export function pixelEllipse(camera, point, covariance) {
  const slopes = slopesAt(camera, point);
  if (!slopes) return null;
  const [xs, ys] = slopes;
  const [xx, xy, yy] = [spread(xs, covariance, xs), spread(xs, covariance, ys), spread(ys, covariance, ys)];
  const middle = (xx + yy) / 2;
  const away = Math.hypot((xx - yy) / 2, xy);
  return {
    major: Math.sqrt(middle + away),
    minor: Math.sqrt(Math.max(middle - away, 0)),
    turn: (Math.atan2(2 * xy, xx - yy) * 90) / Math.PI,
  };
}

/** How x and y of the pixel change with the point. @param {import("./camera.js").Camera} camera @param {number[]} point */
function slopesAt(camera, point) {
  const here = shown(camera, point);
  const moved = point.map((_, axis) =>
    shown(
      camera,
      point.map((value, place) => value + (place === axis ? SMALL : 0)),
    ),
  );
  if (!here || !moved.every((pixel) => pixel !== null)) return null;
  return [moved.map(({ x }) => (x - here.x) / SMALL), moved.map(({ y }) => (y - here.y) / SMALL)];
}

/** @param {number[]} left @param {number[][]} covariance @param {number[]} right */
function spread(left, covariance, right) {
  return left.reduce(
    (sum, value, row) => sum + value * covariance[row].reduce((part, each, column) => part + each * right[column], 0),
    0,
  );
}
