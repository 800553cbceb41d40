/**
 * One ground point from clicks in several views.
 * @typedef {import("./camera.js").AnyCamera} AnyCamera
 * @typedef {import("./lens.js").XY} XY
 * @typedef {{camera: AnyCamera, u: number, v: number, z?: number}} Click `z`: metres above the ground point of what
 *   was clicked on; 0 is the feet
 * @typedef {XY & {residuals: number[]}} Intersection metres, and how far each click is off in pixels
 * @typedef {XY & {misses: XY[], cost: number}} Candidate misses in pixels, and their sum of squares
 */
import { backProject, project } from "./camera.js";

const STEPS = 30;
const SMALL = 1e-4; // metres
const CONVERGED = 1e-9; // metres
const AXES = /** @type {const} */ (["x", "y"]);

/**
 * The ground point that clicks show: the least squares of the distances in pixels in all views, by damped
 * Gauss-Newton from the best single click.
 *
 * @param {Click[]} clicks
 * @returns {Intersection|null} null when no click meets the ground, or the point is not in front of every camera
 */
export function groundPoint(clicks) {
  let best = startingPoint(clicks);
  let damping = 1e-3;
  for (let step = 0; best && step < STEPS; step += 1) {
    const move = newtonMove(clicks, best, damping);
    if (!move) break;
    const next = evaluated(clicks, best.x + move.x, best.y + move.y);
    if (next && next.cost <= best.cost) {
      best = next;
      damping /= 10;
      if (Math.hypot(move.x, move.y) < CONVERGED) break;
    } else {
      damping *= 10;
    }
  }
  return best && { x: best.x, y: best.y, residuals: best.misses.map(({ x, y }) => Math.hypot(x, y)) };
}

/** @param {Click[]} clicks @returns {Candidate|null} */
function startingPoint(clicks) {
  /** @type {Candidate|null} */
  let best = null;
  for (const { camera, u, v, z } of clicks) {
    const ground = backProject(camera, u, v, z);
    const candidate = ground && evaluated(clicks, ground.x, ground.y);
    if (candidate && !(best && best.cost <= candidate.cost)) best = candidate;
  }
  return best;
}

/**
 * A ground point with its misses in pixels and their sum of squares; null when a view cannot show it.
 * @param {Click[]} clicks @param {number} x @param {number} y @returns {Candidate|null}
 */
function evaluated(clicks, x, y) {
  const misses = missesAt(clicks, x, y);
  return misses && { x, y, misses, cost: misses.reduce((sum, miss) => sum + miss.x ** 2 + miss.y ** 2, 0) };
}

/** @param {Click[]} clicks @param {number} x @param {number} y @returns {XY[]|null} */
function missesAt(clicks, x, y) {
  const misses = [];
  for (const { camera, u, v, z } of clicks) {
    const point = project(camera, x, y, z);
    if (!point) return null;
    misses.push({ x: point.x - u, y: point.y - v });
  }
  return misses;
}

/**
 * Solves the 2×2 normal equations with the damping of Levenberg and Marquardt.
 * @param {Click[]} clicks @param {Candidate} from @param {number} damping @returns {XY|null}
 */
function newtonMove(clicks, { x, y, misses }, damping) {
  const [byX, byY] = [missesAt(clicks, x + SMALL, y), missesAt(clicks, x, y + SMALL)];
  if (!byX || !byY) return null;
  let [xx, xy, yy, gx, gy] = [0, 0, 0, 0, 0];
  misses.forEach((miss, index) => {
    for (const axis of AXES) {
      const slopeX = (byX[index][axis] - miss[axis]) / SMALL;
      const slopeY = (byY[index][axis] - miss[axis]) / SMALL;
      xx += slopeX * slopeX;
      xy += slopeX * slopeY;
      yy += slopeY * slopeY;
      gx += slopeX * miss[axis];
      gy += slopeY * miss[axis];
    }
  });
  xx *= 1 + damping;
  yy *= 1 + damping;
  const determinant = xx * yy - xy * xy;
  if (!(determinant > 0)) return null;
  return { x: (xy * gy - yy * gx) / determinant, y: (xy * gx - xx * gy) / determinant };
}
