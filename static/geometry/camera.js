import { Lens, Point } from "./lens.js";

const STEEP = 0.1; // below this share of "up" in the image, a camera counts as looking straight down or up

/** Models this module knows; of cameras with others see table_camera.js. */
export const MODELS = ["pinhole"];

/**
 * @typedef {object} CameraJSON a calibration in OpenCV's model, as the server sends it
 * @property {number} index viewNum in files
 * @property {string} name
 * @property {number} width pixels
 * @property {number} height pixels
 * @property {number[][]} matrix 3×3, pixels
 * @property {number[][]} rotation 3×3, world to camera
 * @property {number[]} tvec 3, metres, world to camera
 * @property {number[]} distortion OpenCV's order; zeros for undistorted images
 * @property {string} [model] "pinhole" unless it is said: what the numbers of distortion mean
 * @property {string} grid address of its rectangles, see grid_file.js
 *
 * @typedef {import("./lens.js").XY} XY
 * @typedef {import("./table_camera.js").TableCamera} TableCamera
 * @typedef {Camera|TableCamera} AnyCamera which of the two, `byTable` says
 */

/** A calibrated static camera. World coordinates are metres, the ground is z = 0, pixels are x right, y down. */
export class Camera {
  /** @param {CameraJSON} json */
  constructor({ index, name, width, height, matrix, rotation, tvec, distortion }) {
    this.index = index;
    this.name = name;
    this.width = width;
    this.height = height;
    /** @type {false} */
    this.byTable = false;
    this.fx = matrix[0][0];
    this.cx = matrix[0][2];
    this.fy = matrix[1][1];
    this.cy = matrix[1][2];
    this.rotation = Float64Array.from(rotation.flat());
    this.tvec = Float64Array.from(tvec);
    this.lens = distortion.some((value) => value !== 0) ? new Lens(distortion) : null;
    this.centre = [0, 1, 2].map((axis) => -this._turnedBack(tvec[0], tvec[1], tvec[2], axis));
    const [down, away] = [this.rotation[5], this.rotation[8]];
    // Sign of the depth of what the camera sees: -1 for the poses of left-handed worlds.
    this.facing = (Math.abs(down) > STEEP ? down : away) > 0 ? -1 : 1;
    // Projection as sums of one term per world axis; without a lens the focal lengths are multiplied in.
    const scale = this.lens ? [1, 1, 1] : [this.fx, this.fy, 1];
    this.terms = this.rotation.map((value, place) => scale[Math.floor(place / 3)] * value);
    this.offset = this.tvec.map((value, axis) => scale[axis] * value);
  }

  /**
   * Direction x/z, y/z of a pixel with the lens taken out, into `out`; false if nothing lands there.
   * @param {number} u @param {number} v @param {XY} out
   */
  normalise(u, v, out) {
    out.x = (u - this.cx) / this.fx;
    out.y = (v - this.cy) / this.fy;
    return this.lens ? this.lens.undistort(out.x, out.y, out) : true;
  }

  /**
   * World coordinates along the ray of a direction, for one unit of depth.
   * @param {number} x @param {number} y
   */
  ray(x, y) {
    return [0, 1, 2].map((axis) => this._turnedBack(x, y, 1, axis));
  }

  /**
   * A world point in camera axes, [x, y, depth].
   * @param {number} x @param {number} y @param {number} z
   */
  seen(x, y, z) {
    const [r, t] = [this.rotation, this.tvec];
    return [0, 1, 2].map((axis) => r[3 * axis] * x + r[3 * axis + 1] * y + r[3 * axis + 2] * z + t[axis]);
  }

  /**
   * Pixel of a direction, into `out`.
   * @template {XY} Into
   * @param {number} x @param {number} y @param {Into} out
   */
  pixel(x, y, out) {
    out.x = x;
    out.y = y;
    if (this.lens) this.lens.distort(x, y, out);
    out.x = out.x * this.fx + this.cx;
    out.y = out.y * this.fy + this.cy;
    return out;
  }

  /** @param {number} x @param {number} y @param {number} z @param {number} axis */
  _turnedBack(x, y, z, axis) {
    return this.rotation[axis] * x + this.rotation[axis + 3] * y + this.rotation[axis + 6] * z;
  }
}

/**
 * Pixel of a world point in metres; null behind the camera and where the lens model folds back.
 *
 * @param {AnyCamera} camera
 * @param {number} x @param {number} y @param {number} [z]
 * @returns {XY|null}
 */
export function project(camera, x, y, z = 0) {
  if (camera.byTable) return camera.toPixel(x, y, z);
  const [right, down, depth] = camera.seen(x, y, z);
  if (!(depth * camera.facing > 0)) return null;
  if (camera.lens && !(Math.hypot(right, down) / Math.abs(depth) < camera.lens.limit)) return null;
  const { x: u, y: v } = camera.pixel(right / depth, down / depth, new Point());
  return { x: u, y: v };
}

/**
 * World point in metres that a pixel shows at height `z`, the inverse of `project`; null above the horizon.
 *
 * @param {AnyCamera} camera
 * @param {number} u @param {number} v @param {number} [z]
 * @returns {XY|null}
 */
export function backProject(camera, u, v, z = 0) {
  if (camera.byTable) return camera.toGround(u, v, z);
  const direction = new Point();
  if (!camera.normalise(u, v, direction)) return null;
  const [x, y, up] = camera.ray(direction.x, direction.y);
  const depth = (z - camera.centre[2]) / up;
  if (!(Number.isFinite(depth) && depth * camera.facing > 0)) return null;
  return { x: camera.centre[0] + depth * x, y: camera.centre[1] + depth * y };
}
