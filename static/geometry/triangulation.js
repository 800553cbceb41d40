/** One ground point from clicks in several views. */
import { backProject, project } from "./camera.js";

const STEPS = 30;
const SMALL = 1e-4; // metres
const CONVERGED = 1e-9; // metres

/**
 * The ground point that two clicks show: the least squares of the distances in pixels in both views.
 *
 * @returns {{x: number, y: number, residuals: number[]}|null} metres, and how far each click is off in pixels;
 *   null when neither click meets the ground, or the point is not in front of both cameras
 */
export function intersectRays(camera1, u1, v1, camera2, u2, v2) {
  return groundPoint([
    { camera: camera1, u: u1, v: v1 },
    { camera: camera2, u: u2, v: v2 },
  ]);
}

/**
 * The same for any number of clicks, by damped Gauss-Newton from the best single click.
 *
 * @param {{camera: import("./camera.js").Camera, u: number, v: number, z?: number}[]} clicks `z`: metres above the
 *   ground point of what was clicked on; 0 is the feet
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

function startingPoint(clicks) {
  return clicks
    .map(({ camera, u, v, z }) => backProject(camera, u, v, z))
    .map((ground) => ground && evaluated(clicks, ground.x, ground.y))
    .filter(Boolean)
    .reduce((best, candidate) => (best && best.cost <= candidate.cost ? best : candidate), null);
}

/** A ground point with its misses in pixels and their sum of squares; null when a view cannot show it. */
function evaluated(clicks, x, y) {
  const misses = missesAt(clicks, x, y);
  return misses && { x, y, misses, cost: misses.reduce((sum, miss) => sum + miss.x ** 2 + miss.y ** 2, 0) };
}

function missesAt(clicks, x, y) {
  const seen = clicks.map(({ camera, z }) => project(camera, x, y, z));
  if (seen.includes(null)) return null;
  return seen.map((point, index) => ({ x: point.x - clicks[index].u, y: point.y - clicks[index].v }));
}

/** Solves the 2×2 normal equations with the damping of Levenberg and Marquardt. */
function newtonMove(clicks, { x, y, misses }, damping) {
  const [byX, byY] = [missesAt(clicks, x + SMALL, y), missesAt(clicks, x, y + SMALL)];
  if (!byX || !byY) return null;
  let [xx, xy, yy, gx, gy] = [0, 0, 0, 0, 0];
  misses.forEach((miss, index) => {
    for (const axis of ["x", "y"]) {
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
