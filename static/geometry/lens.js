/**
 * OpenCV's lens model on normalised coordinates (x/z, y/z): radial, tangential, thin prism, tilt.
 *
 * gtm_hit/geometry/lens.py has the same operations in the same order: results agree to the last bit.
 * @typedef {{x: number, y: number}} XY pixels in a view, metres on the ground, or normalised
 */

const NEWTON_STEPS = 50;
const TOLERANCE = 1e-12; // normalised units; about 1e-9 pixels
const SMALL = 1e-6;

/** A point that functions write into, so that inner loops allocate nothing. */
export class Point {
  /** @param {number} [x] @param {number} [y] */
  constructor(x = 0, y = 0) {
    this.x = x;
    this.y = y;
  }
}

export class Lens {
  /** @param {number[]} distortion k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4 tau_x tau_y; missing ones are 0 */
  constructor(distortion) {
    const full = Array.from({ length: 14 }, (_, index) => distortion[index] ?? 0);
    this.k1 = full[0];
    this.k2 = full[1];
    this.p1 = full[2];
    this.p2 = full[3];
    this.k3 = full[4];
    this.k4 = full[5];
    this.k5 = full[6];
    this.k6 = full[7];
    this.s1 = full[8];
    this.s2 = full[9];
    this.s3 = full[10];
    this.s4 = full[11];
    this.tilt = full[12] || full[13] ? tiltMatrix(full[12], full[13]) : null;
    this.untilt = this.tilt && inverse(this.tilt);
    /** Radius in normalised units beyond which nothing is seen. */
    this.limit = foldRadius(this);
  }

  /**
   * Where the lens moves a normalised point to; into `out`.
   * @param {number} x @param {number} y @param {XY} out
   */
  distort(x, y, out) {
    this._bend(x, y, out);
    if (this.tilt) applyHomography(this.tilt, out.x, out.y, out);
  }

  /**
   * Inverse of `distort`; false where no point inside the lens's limit lands there.
   * @param {number} x @param {number} y @param {XY} out
   */
  undistort(x, y, out) {
    const goal = new Point(x, y);
    if (this.untilt) applyHomography(this.untilt, x, y, goal);
    out.x = goal.x;
    out.y = goal.y;
    for (let step = 0; step < NEWTON_STEPS; step += 1) {
      if (!(this._newtonStep(goal, out) > TOLERANCE)) break;
    }
    const landed = new Point();
    this._bend(out.x, out.y, landed);
    return Math.hypot(landed.x - goal.x, landed.y - goal.y) < 1e-9 && Math.hypot(out.x, out.y) < this.limit;
  }

  /** @param {number} x @param {number} y @param {XY} out */
  _bend(x, y, out) {
    const r2 = x * x + y * y;
    const r4 = r2 * r2;
    const r6 = r4 * r2;
    const numerator = 1 + this.k1 * r2 + this.k2 * r4 + this.k3 * r6;
    const radial = numerator * (1 / (1 + this.k4 * r2 + this.k5 * r4 + this.k6 * r6));
    const cross = 2 * x * y;
    out.x = x * radial + this.p1 * cross + this.p2 * (r2 + 2 * x * x) + this.s1 * r2 + this.s2 * r4;
    out.y = y * radial + this.p1 * (r2 + 2 * y * y) + this.p2 * cross + this.s3 * r2 + this.s4 * r4;
  }

  /**
   * Moves `at` towards the point that lands on `goal`; returns how far.
   * @param {XY} goal @param {XY} at
   */
  _newtonStep(goal, at) {
    const [here, right, left, down, up] = [new Point(), new Point(), new Point(), new Point(), new Point()];
    this._bend(at.x, at.y, here);
    this._bend(at.x + SMALL, at.y, right);
    this._bend(at.x - SMALL, at.y, left);
    this._bend(at.x, at.y + SMALL, down);
    this._bend(at.x, at.y - SMALL, up);
    const [xx, yx] = [(right.x - left.x) / (2 * SMALL), (right.y - left.y) / (2 * SMALL)];
    const [xy, yy] = [(down.x - up.x) / (2 * SMALL), (down.y - up.y) / (2 * SMALL)];
    const determinant = xx * yy - xy * yx;
    const [missX, missY] = [here.x - goal.x, here.y - goal.y];
    const [stepX, stepY] = [(yy * missX - xy * missY) / determinant, (xx * missY - yx * missX) / determinant];
    at.x -= stepX;
    at.y -= stepY;
    return Math.abs(stepX) + Math.abs(stepY);
  }
}

/**
 * Radius in normalised units beyond which the radial model folds back; Infinity for a sane lens.
 * @param {Pick<Lens, "k1"|"k2"|"k3"|"k4"|"k5"|"k6">} lens
 */
function foldRadius({ k1, k2, k3, k4, k5, k6 }) {
  let landedBefore = 0;
  for (let index = 1; index <= 10000; index += 1) {
    const r = index * 0.001;
    const r2 = r * r;
    const landed = (r * (1 + r2 * (k1 + r2 * (k2 + r2 * k3)))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)));
    if (!(landed > landedBefore)) return r;
    landedBefore = landed;
  }
  return Infinity;
}

/**
 * Homography of a tilted sensor, row by row.
 * @param {number} tauX @param {number} tauY
 */
function tiltMatrix(tauX, tauY) {
  const [sinX, cosX, sinY, cosY] = [Math.sin(tauX), Math.cos(tauX), Math.sin(tauY), Math.cos(tauY)];
  const tilted = [cosY, sinY * sinX, -sinY * cosX, 0, cosX, sinX, sinY, -cosY * sinX, cosY * cosX];
  const [, , t02, , , t12, , , t22] = tilted;
  return multiply([t22, 0, -t02, 0, t22, -t12, 0, 0, 1], tilted);
}

/** @param {number[]} a @param {number[]} b 3×3, row by row */
function multiply(a, b) {
  return a.map((_, index) => {
    const [row, column] = [3 * Math.floor(index / 3), index % 3];
    return a[row] * b[column] + a[row + 1] * b[column + 3] + a[row + 2] * b[column + 6];
  });
}

/** @param {number[]} matrix 3×3, row by row */
function inverse([a, b, c, d, e, f, g, h, i]) {
  const determinant = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g);
  const adjugate = [
    [e * i - f * h, c * h - b * i, b * f - c * e],
    [f * g - d * i, a * i - c * g, c * d - a * f],
    [d * h - e * g, b * g - a * h, a * e - b * d],
  ];
  return adjugate.flat().map((value) => value / determinant);
}

/** @param {number[]} m @param {number} x @param {number} y @param {XY} out */
function applyHomography(m, x, y, out) {
  const scale = 1 / (m[6] * x + m[7] * y + m[8]);
  out.x = (m[0] * x + m[1] * y + m[2]) * scale;
  out.y = (m[3] * x + m[4] * y + m[5]) * scale;
}
