/**
 * Where in the world clicks in several views meet, and how sure that is; gtm_hit/calibration/checking.py does the
 * same, and both are held against fixtures/check_cases.json.
 * @typedef {import("./camera.js").Camera} Camera
 * @typedef {{camera: Camera, u: number, v: number}} SpatialClick pixels of the picture as taken
 * @typedef {object} Spot
 * @property {number[]} point metres; the ground position is its first two, the height its third
 * @property {number[]} sigmas ± metres along X, Y and Z
 * @property {number} groundSigma ± metres on the ground, X and Y together
 * @property {number[][]} covariance 3×3, metres²
 * @property {number[]} residuals pixels, click by click
 * @property {boolean[]} doubtful beyond 3 σ: the click that spoils the others' agreement, or both where there are two
 * @property {number} angle degrees at which the two rays cross that cross best; where it is small, ± is large
 */
import { inverse, solve } from "./cubes.js";
import { Point } from "./lens.js";

export const CLICK_SIGMA = 2; // pixels: of a careful click, with what calibrations are usually off
const DOUBT = 3; // σ beyond which a click is marked
const STEPS = 30;
const SMALL = 1e-4; // metres
const CONVERGED = 1e-9; // metres
const PARALLEL = 1e-9; // of the determinant of what the rays tell together: below it they do not meet
const AXES = [0, 1, 2];

/**
 * The point with the least squares of the misses in pixels, `sigma` being that of one click.
 * @param {SpatialClick[]} clicks @param {number} [sigma]
 * @returns {Spot|null} null for fewer than two clicks, for parallel rays, and where they meet behind a camera
 */
export function spot(clicks, sigma = CLICK_SIGMA) {
  const found = meeting(clicks);
  const slopes = found && slopesAt(clicks, found.point, found.misses);
  if (!found || !slopes) return null;
  const spare = Math.max(2 * clicks.length - 3, 1);
  // Clicks that disagree by more than σ say themselves that it is larger.
  const variance = Math.max(sigma ** 2, found.cost / spare);
  const covariance = inverse(squares(slopes)).map((row) => row.map((value) => value * variance));
  const doubts = new Set(doubtful(clicks, found.misses, sigma));
  return {
    point: found.point,
    covariance,
    sigmas: AXES.map((axis) => Math.sqrt(covariance[axis][axis])),
    groundSigma: Math.sqrt(covariance[0][0] + covariance[1][1]),
    residuals: lengths(found.misses),
    doubtful: clicks.map((_, place) => doubts.has(place)),
    angle: crossing(clicks),
  };
}

/**
 * Pixel of a world point; null behind the camera and beyond the fold of its lens.
 * @param {Camera} camera @param {number[]} point @returns {import("./lens.js").XY|null}
 */
export function shown(camera, [x, y, z]) {
  const [right, down, depth] = camera.seen(x, y, z);
  if (!(depth * camera.facing > 0)) return null;
  if (camera.lens && !(Math.hypot(right, down) / Math.abs(depth) < camera.lens.limit)) return null;
  return camera.pixel(right / depth, down / depth, new Point());
}

/**
 * Direction of a click into the world, of length 1; null where the lens shows nothing.
 * @param {SpatialClick} click @returns {number[]|null}
 */
export function rayOf({ camera, u, v }) {
  const direction = new Point();
  if (!camera.normalise(u, v, direction)) return null;
  const ray = camera.ray(direction.x, direction.y);
  const length = camera.facing * Math.hypot(...ray);
  return ray.map((value) => value / length);
}

/**
 * @typedef {{point: number[], misses: number[], cost: number}} Meeting misses as u, v, u, v, … in pixels
 */

/**
 * Damped Gauss and Newton from where the rays come closest; null where that is in no view.
 * @param {SpatialClick[]} clicks @returns {Meeting|null}
 */
function meeting(clicks) {
  const start = clicks.length < 2 ? null : closest(clicks);
  let best = start && evaluated(clicks, start);
  let damping = 1e-3;
  for (let step = 0; best && step < STEPS; step += 1) {
    const slopes = slopesAt(clicks, best.point, best.misses);
    if (!slopes) break;
    const normal = squares(slopes);
    for (const axis of AXES) normal[axis][axis] *= 1 + damping;
    const move = solve(normal, pulls(slopes, best.misses));
    const next = evaluated(
      clicks,
      best.point.map((value, axis) => value - move[axis]),
    );
    if (next && next.cost <= best.cost) {
      best = next;
      damping /= 10;
      if (Math.max(...move.map(Math.abs)) < CONVERGED) break;
    } else {
      damping *= 10;
    }
  }
  return best;
}

/** @param {SpatialClick[]} clicks @param {number[]} point @returns {Meeting|null} */
function evaluated(clicks, point) {
  const misses = missesAt(clicks, point);
  return misses && { point, misses, cost: misses.reduce((sum, miss) => sum + miss * miss, 0) };
}

/** @param {SpatialClick[]} clicks @param {number[]} point */
function missesAt(clicks, point) {
  const misses = [];
  for (const { camera, u, v } of clicks) {
    const pixel = shown(camera, point);
    if (!pixel) return null;
    misses.push(pixel.x - u, pixel.y - v);
  }
  return misses;
}

/**
 * How the misses change with the point, axis by axis.
 * @param {SpatialClick[]} clicks @param {number[]} point @param {number[]} misses @returns {number[][]|null}
 */
function slopesAt(clicks, point, misses) {
  const slopes = [];
  for (const axis of AXES) {
    const moved = missesAt(
      clicks,
      point.map((value, place) => value + (place === axis ? SMALL : 0)),
    );
    if (!moved) return null;
    slopes.push(moved.map((miss, place) => (miss - misses[place]) / SMALL));
  }
  return slopes;
}

/** @param {number[][]} slopes axis by axis */
function squares(slopes) {
  return slopes.map((one) => slopes.map((other) => dot(one, other)));
}

/** @param {number[][]} slopes @param {number[]} misses */
function pulls(slopes, misses) {
  return slopes.map((slope) => dot(slope, misses));
}

/** @param {SpatialClick[]} clicks @returns {number[]|null} */
function closest(clicks) {
  const total = AXES.map(() => [0, 0, 0]);
  const towards = [0, 0, 0];
  for (const click of clicks) {
    const ray = rayOf(click);
    if (!ray) return null;
    for (const row of AXES) {
      for (const column of AXES) {
        const across = (row === column ? 1 : 0) - ray[row] * ray[column];
        total[row][column] += across;
        towards[row] += across * click.camera.centre[column];
      }
    }
  }
  return solve(total, towards, PARALLEL);
}

/**
 * Places of the clicks that are off by more than 3 σ once those are left out that spoil the rest.
 * @param {SpatialClick[]} clicks @param {number[]} misses @param {number} sigma @returns {number[]}
 */
function doubtful(clicks, misses, sigma) {
  if (!lengths(misses).some((length) => length > DOUBT * sigma)) return [];
  if (clicks.length === 2) return [0, 1];
  const without = clicks.map((_, left) => meeting(clicks.filter((__, place) => place !== left)));
  const costs = without.map((found) => found?.cost ?? Infinity);
  const worst = costs.indexOf(Math.min(...costs));
  const others = clicks.map((_, place) => place).filter((place) => place !== worst);
  const rest = without[worst];
  if (!rest) return [worst];
  const further = doubtful(
    others.map((place) => clicks[place]),
    rest.misses,
    sigma,
  );
  return [worst, ...further.map((place) => others[place])];
}

/** @param {SpatialClick[]} clicks */
function crossing(clicks) {
  const rays = clicks.map(rayOf).filter((ray) => ray !== null);
  let best = 0;
  rays.forEach((one, place) => {
    for (const other of rays.slice(0, place)) best = Math.max(best, Math.hypot(...cross(one, other)));
  });
  return (Math.asin(Math.min(1, best)) * 180) / Math.PI;
}

/** @param {number[]} a @param {number[]} b */
function cross([a, b, c], [d, e, f]) {
  return [b * f - c * e, c * d - a * f, a * e - b * d];
}

/** @param {number[]} one @param {number[]} other */
function dot(one, other) {
  return one.reduce((sum, value, place) => sum + value * other[place], 0);
}

/** @param {number[]} misses u, v, u, v, … */
function lengths(misses) {
  return misses.filter((_, place) => place % 2 === 0).map((miss, place) => Math.hypot(miss, misses[2 * place + 1]));
}
