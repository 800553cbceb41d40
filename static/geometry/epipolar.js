/**
 * Where other views must show what was clicked in one; gtm_hit/calibration/checking.py draws the same line.
 * @typedef {import("./camera.js").Camera} Camera
 * @typedef {import("./lens.js").XY} XY
 * @typedef {import("./spatial.js").SpatialClick} SpatialClick
 */
import { Point } from "./lens.js";
import { rayOf } from "./spatial.js";

const NEAREST = 0.05; // metres before a camera from which on it can see anything
const FARTHEST = 1000; // metres that a ray into the sky is followed
const PIECES = 64; // of a line

/**
 * Pixels of `other` on which lies what was clicked, wherever along the ray it is: from the clicking camera outwards
 * until the ray meets the ground, or very far; only what `other` sees, so there may be none.
 * @param {SpatialClick} click @param {Camera} other @returns {XY[]}
 */
export function epipolarLine(click, other) {
  const ray = rayOf(click);
  const segment = ray && inFront(other, click.camera.centre, ray, reach(click.camera, ray));
  if (!segment) return [];
  // In the normalised plane the line is straight; the lens bends it afterwards.
  const [first, last] = segment.map(([right, down, depth]) => [right / depth, down / depth]);
  const part = within(first, last, seenRadius(other));
  if (!part) return [];
  const [enters, leaves] = part;
  return Array.from({ length: PIECES + 1 }, (_, piece) => {
    const along = enters + (piece / PIECES) * (leaves - enters);
    const [x, y] = first.map((value, axis) => value + along * (last[axis] - value));
    const { x: u, y: v } = other.pixel(x, y, new Point());
    return { x: u, y: v };
  });
}

/**
 * Metres along a ray to the ground; very far where it does not come down.
 * @param {Camera} camera @param {number[]} ray
 */
function reach(camera, ray) {
  const down = -camera.centre[2] / ray[2];
  return down > 0 && down < FARTHEST ? down : FARTHEST;
}

/**
 * Ends of a segment in a camera's axes, cut off where it goes behind it; null where none of it is in front.
 * @param {Camera} camera @param {number[]} start @param {number[]} ray @param {number} metres
 */
function inFront(camera, start, ray, metres) {
  const [x, y, z] = start.map((value, axis) => value + ray[axis] * metres);
  const [first, last] = [camera.seen(start[0], start[1], start[2]), camera.seen(x, y, z)];
  const [near, far] = [first[2] * camera.facing, last[2] * camera.facing];
  if (near < NEAREST && far < NEAREST) return null;
  if (near < NEAREST) return [between(first, last, (NEAREST - near) / (far - near)), last];
  if (far < NEAREST) return [first, between(last, first, (NEAREST - far) / (near - far))];
  return [first, last];
}

/** @param {number[]} from @param {number[]} to @param {number} share */
function between(from, to, share) {
  return from.map((value, axis) => value + share * (to[axis] - value));
}

/**
 * Normalised radius of the farthest corner that shows anything, or the lens' fold.
 * @param {Camera} camera
 */
function seenRadius(camera) {
  const direction = new Point();
  let radius = 0;
  for (const u of [0, camera.width - 1]) {
    for (const v of [0, camera.height - 1]) {
      if (!camera.normalise(u, v, direction)) return camera.lens?.limit ?? Infinity;
      radius = Math.max(radius, Math.hypot(direction.x, direction.y));
    }
  }
  return radius;
}

/**
 * From where to where, as shares of it, a segment of the plane runs within a circle.
 * @param {number[]} first @param {number[]} last @param {number} radius @returns {[number, number]|null}
 */
function within(first, last, radius) {
  if (!Number.isFinite(radius)) return [0, 1];
  const away = [last[0] - first[0], last[1] - first[1]];
  const a = away[0] * away[0] + away[1] * away[1];
  const b = first[0] * away[0] + first[1] * away[1];
  const c = first[0] * first[0] + first[1] * first[1] - radius * radius;
  const inside = b * b - a * c;
  if (!(inside > 0 && a > 0)) return null;
  const enters = Math.max(0, (-b - Math.sqrt(inside)) / a);
  const leaves = Math.min(1, (-b + Math.sqrt(inside)) / a);
  return enters < leaves ? [enters, leaves] : null;
}
