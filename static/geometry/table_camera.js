import { footX, footY, isVisible, nearestFoot } from "./feet.js";

const REACH = 24; // pixels a click may miss the nearest foot
const SAMPLES = 4; // on either side of a place, along columns and along rows
const NARROW = [4, 8]; // positions on either side; without enough people in the second nothing is said about a place
const WIDE = [16, 32, 64];
const TOLD = 1; // pixels that feet must lie apart across a window: they are told in quarters of one
const STEPS = 4; // of the search for the place under a pixel
const PIECE = 0.25; // metres, of a line that is drawn
const REMEMBERED = 4000; // places

/**
 * @typedef {import("./lens.js").XY} XY
 * @typedef {{boxes: Int16Array, feet: Int16Array, index: import("./feet.js").FootIndex}} Table
 */

/**
 * A camera whose model only the server knows: what it sees is read off its table of rectangles. A place is seen where
 * the feet around it say, by the plane that fits them best: that evens out the table's rounding, and reaches a
 * little beyond where somebody is visible. Heights other than the ground are not in the table.
 */
export class TableCamera {
  /**
   * @param {import("./camera.js").CameraJSON} json
   * @param {import("./grid.js").Grid} grid
   * @param {Table} table
   */
  constructor({ name, width, height, rotation, tvec, index: number }, grid, { boxes, feet, index }) {
    this.index = number;
    this.name = name;
    this.width = width;
    this.height = height;
    /** @type {true} */
    this.byTable = true;
    this.centre = [0, 1, 2].map(
      (axis) => -(rotation[0][axis] * tvec[0] + rotation[1][axis] * tvec[1] + rotation[2][axis] * tvec[2]),
    );
    this._grid = grid;
    this._feet = { boxes, feet, width, height };
    this._index = index;
    /** @type {Map<string, Plane|null>} */
    this._fits = new Map();
  }

  /**
   * Pixel of a ground point in metres; null where nobody would be seen, and at other heights.
   * @param {number} x @param {number} y @param {number} [z] @returns {XY|null}
   */
  toPixel(x, y, z = 0) {
    const [column, row] = this._cells(x, y);
    const fit = z === 0 ? this._fit(column, row) : null;
    return fit ? fit.at(column, row) : null;
  }

  /**
   * Ground point in metres whose feet a pixel shows; null where no foot is near, and at other heights.
   * @param {number} u @param {number} v @param {number} [z] @returns {XY|null}
   */
  toGround(u, v, z = 0) {
    const nearest = z === 0 ? nearestFoot(this._feet, this._index, u, v, REACH) : null;
    if (nearest === null) return null;
    let [column, row] = [nearest % this._grid.columns, Math.floor(nearest / this._grid.columns)];
    for (let step = 0; step < STEPS; step += 1) {
      const next = this._fit(column, row)?.inverse(u, v);
      if (!next || !this._fit(next[0], next[1])) break;
      [column, row] = next;
    }
    const { origin, extent, columns, rows } = this._grid;
    return { x: origin[0] + (column * extent[0]) / columns, y: origin[1] + (row * extent[1]) / rows };
  }

  /**
   * Which way on the screen the ground's x (axis 0) or y (axis 1) leads, as a unit vector; null where unknown.
   * @param {number} x @param {number} y @param {0|1} axis @returns {XY|null}
   */
  direction(x, y, axis) {
    const [column, row] = this._cells(x, y);
    const fit = this._fit(column, row);
    const [right, down] = fit ? fit.slopes[axis] : [0, 0];
    const length = Math.hypot(right, down);
    return length > 0 ? { x: right / length, y: down / length } : null;
  }

  /**
   * The straight line between two ground points, as far as feet are seen along it.
   * @param {number} x1 @param {number} y1 @param {number} x2 @param {number} y2
   * @returns {XY[][]} polylines
   */
  line(x1, y1, x2, y2) {
    const pieces = Math.max(1, Math.ceil(Math.hypot(x2 - x1, y2 - y1) / PIECE));
    /** @type {XY[]} */
    let line = [];
    const lines = [line];
    for (let piece = 0; piece <= pieces; piece += 1) {
      const share = piece / pieces;
      const pixel = this.toPixel(x1 + (x2 - x1) * share, y1 + (y2 - y1) * share);
      if (pixel) line.push(pixel);
      else if (line.length) {
        line = [];
        lines.push(line);
      }
    }
    return lines.filter(({ length }) => length > 1);
  }

  /** Corners of the ground whose feet are inside the picture, metres: row by row its ends. */
  outline() {
    const { columns, rows } = this._grid;
    /** @type {XY[]} */
    const lefts = [];
    /** @type {XY[]} */
    const rights = [];
    for (let row = 0; row < rows; row += 1) {
      /** @param {number} column */
      const seen = (column) => this._isInPicture(row * columns + column);
      let [left, right] = [0, columns - 1];
      while (left < columns && !seen(left)) left += 1;
      if (left === columns) continue;
      while (!seen(right)) right -= 1;
      lefts.push(this._grid.metres(row * columns + left));
      rights.unshift(this._grid.metres(row * columns + right));
    }
    return [...lefts, ...rights];
  }

  /** @param {number} position */
  _isInPicture(position) {
    const [x, y] = [footX(this._feet, position), footY(this._feet, position)];
    return isVisible(this._feet, position) && x >= 0 && y >= 0 && x < this.width && y < this.height;
  }

  /**
   * Columns and rows of a ground point, with their fractions.
   * @param {number} x @param {number} y
   */
  _cells(x, y) {
    const { origin, step } = this._grid;
    return [(x - origin[0]) / step, (y - origin[1]) / step];
  }

  /**
   * The plane of the feet around a place, from the narrowest window that tells directions apart; null: unknown.
   * @param {number} column @param {number} row @returns {Plane|null}
   */
  _fit(column, row) {
    const [c, r] = [Math.round(column), Math.round(row)];
    const key = `${c} ${r}`;
    let fit = this._fits.get(key);
    if (fit === undefined) {
      if (this._fits.size > REMEMBERED) this._fits.clear();
      fit = this._search(c, r);
      this._fits.set(key, fit);
    }
    return fit;
  }

  /** @param {number} column @param {number} row */
  _search(column, row) {
    /** @type {Plane|null} */
    let found = null;
    for (const reach of [...NARROW, ...WIDE]) {
      if (!found && WIDE.includes(reach)) return null;
      found = this._plane(column, row, reach) ?? found;
      if (found?.tells(reach)) return found;
    }
    return found;
  }

  /** @param {number} column @param {number} row @param {number} reach */
  _plane(column, row, reach) {
    const { columns, rows } = this._grid;
    /** @type {number[][]} */
    const samples = [];
    for (let r = row - reach; r <= row + reach; r += reach / SAMPLES) {
      for (let c = column - reach; c <= column + reach; c += reach / SAMPLES) {
        if (c < 0 || r < 0 || c >= columns || r >= rows || !isVisible(this._feet, r * columns + c)) continue;
        const position = r * columns + c;
        samples.push([c, r, footX(this._feet, position), footY(this._feet, position)]);
      }
    }
    return Plane.through(samples);
  }
}

/** Pixels as a linear function of columns and rows. */
class Plane {
  /**
   * @param {number[]} middle [column, row, u, v]
   * @param {number[][]} slopes [[u, v] per column, [u, v] per row]
   */
  constructor(middle, slopes) {
    this.middle = middle;
    this.slopes = slopes;
  }

  /**
   * The one that fits best, by least squares; null when the samples lie on one line.
   * @param {number[][]} samples [column, row, u, v]
   */
  static through(samples) {
    /** @param {number[]} values */
    const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
    const middle = [0, 1, 2, 3].map((axis) => mean(samples.map((one) => one[axis])));
    /** @param {number} one @param {number} other */
    const together = (one, other) =>
      mean(samples.map((sample) => (sample[one] - middle[one]) * (sample[other] - middle[other])));
    const [cc, cr, rr] = [together(0, 0), together(0, 1), together(1, 1)];
    const determinant = cc * rr - cr * cr;
    if (!(determinant > 1e-6)) return null;
    const along = [2, 3].map((axis) => {
      const [c, r] = [together(0, axis), together(1, axis)];
      return [(c * rr - r * cr) / determinant, (r * cc - c * cr) / determinant];
    });
    return new Plane(middle, [along.map(([c]) => c), along.map(([, r]) => r)]);
  }

  /**
   * Whether feet lie so far apart across a window that pixels tell both directions.
   * @param {number} reach
   */
  tells(reach) {
    const lengths = this.slopes.map(([u, v]) => Math.hypot(u, v) * reach);
    return Math.min(...lengths) >= TOLD && Math.abs(this._determinant()) * reach * reach >= TOLD * TOLD;
  }

  /** @param {number} column @param {number} row */
  at(column, row) {
    const [c, r] = [column - this.middle[0], row - this.middle[1]];
    const [x, y] = [0, 1].map((axis) => this.middle[2 + axis] + this.slopes[0][axis] * c + this.slopes[1][axis] * r);
    return { x, y };
  }

  /**
   * [column, row] of a pixel; null where the feet lie on one line.
   * @param {number} u @param {number} v
   */
  inverse(u, v) {
    const determinant = this._determinant();
    if (!(Math.abs(determinant) > 1e-9)) return null;
    const [[uc, vc], [ur, vr]] = this.slopes;
    const [du, dv] = [u - this.middle[2], v - this.middle[3]];
    return [this.middle[0] + (du * vr - dv * ur) / determinant, this.middle[1] + (dv * uc - du * vc) / determinant];
  }

  _determinant() {
    const [[uc, vc], [ur, vr]] = this.slopes;
    return uc * vr - ur * vc;
  }
}
