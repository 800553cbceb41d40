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
 * A camera whose model only the server knows: what it sees is read off its table of rectangles. A place is seen where
 * the feet around it say, by the plane that fits them best: that evens out the table's rounding, and reaches a
 * little beyond where somebody is visible. Heights other than the ground are not in the table.
 */
export class TableCamera {
  /**
   * @param {import("./camera.js").CameraJSON} json
   * @param {import("./grid.js").Grid} grid
   * @param {{boxes: Int16Array, feet: Int16Array, index: import("./feet.js").FootIndex}} table
   */
  constructor({ name, width, height, rotation, tvec, index: number }, grid, { boxes, feet, index }) {
    Object.assign(this, { index: number, name, width, height, byTable: true });
    this.centre = [0, 1, 2].map(
      (axis) => -(rotation[0][axis] * tvec[0] + rotation[1][axis] * tvec[1] + rotation[2][axis] * tvec[2]),
    );
    this._grid = grid;
    this._feet = { boxes, feet, width, height };
    this._index = index;
    this._fits = new Map();
  }

  /** Pixel of a ground point in metres; null where nobody would be seen, and at other heights. */
  toPixel(x, y, z = 0) {
    const [column, row] = this._cells(x, y);
    const fit = z === 0 && this._fit(column, row);
    return fit ? fit.at(column, row) : null;
  }

  /** Ground point in metres whose feet a pixel shows; null where no foot is near, and at other heights. */
  toGround(u, v, z = 0) {
    const nearest = z === 0 ? nearestFoot(this._feet, this._index, u, v, REACH) : null;
    if (nearest === null) return null;
    let place = [nearest % this._grid.columns, Math.floor(nearest / this._grid.columns)];
    for (let step = 0; step < STEPS; step += 1) {
      const next = this._fit(...place)?.inverse(u, v);
      if (!next || !this._fit(...next)) break;
      place = next;
    }
    const { origin, extent, columns, rows } = this._grid;
    return { x: origin[0] + (place[0] * extent[0]) / columns, y: origin[1] + (place[1] * extent[1]) / rows };
  }

  /** Which way on the screen the ground's x (axis 0) or y (axis 1) leads, as a unit vector; null where unknown. */
  direction(x, y, axis) {
    const fit = this._fit(...this._cells(x, y));
    const [right, down] = fit ? fit.slopes[axis] : [0, 0];
    const length = Math.hypot(right, down);
    return length > 0 ? { x: right / length, y: down / length } : null;
  }

  /** The straight line between two ground points, as far as feet are seen along it. @returns {{x, y}[][]} polylines */
  line(x1, y1, x2, y2) {
    const pieces = Math.max(1, Math.ceil(Math.hypot(x2 - x1, y2 - y1) / PIECE));
    const lines = [[]];
    for (let piece = 0; piece <= pieces; piece += 1) {
      const share = piece / pieces;
      const pixel = this.toPixel(x1 + (x2 - x1) * share, y1 + (y2 - y1) * share);
      if (pixel) lines.at(-1).push(pixel);
      else if (lines.at(-1).length) lines.push([]);
    }
    return lines.filter((line) => line.length > 1);
  }

  /** Corners of the ground whose feet are inside the picture, metres: row by row its ends. */
  outline() {
    const { columns, rows } = this._grid;
    const [lefts, rights] = [[], []];
    for (let row = 0; row < rows; row += 1) {
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

  _isInPicture(position) {
    const [x, y] = [footX(this._feet, position), footY(this._feet, position)];
    return isVisible(this._feet, position) && x >= 0 && y >= 0 && x < this.width && y < this.height;
  }

  /** Columns and rows of a ground point, with their fractions. */
  _cells(x, y) {
    const { origin, step } = this._grid;
    return [(x - origin[0]) / step, (y - origin[1]) / step];
  }

  /** The plane of the feet around a place, from the narrowest window that tells directions apart; null: unknown. */
  _fit(column, row) {
    const [c, r] = [Math.round(column), Math.round(row)];
    const key = `${c} ${r}`;
    if (!this._fits.has(key)) {
      if (this._fits.size > REMEMBERED) this._fits.clear();
      this._fits.set(key, this._search(c, r));
    }
    return this._fits.get(key);
  }

  _search(column, row) {
    let found = null;
    for (const reach of [...NARROW, ...WIDE]) {
      if (!found && WIDE.includes(reach)) return null;
      found = this._plane(column, row, reach) ?? found;
      if (found?.tells(reach)) return found;
    }
    return found;
  }

  _plane(column, row, reach) {
    const { columns, rows } = this._grid;
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
  constructor(middle, slopes) {
    this.middle = middle; // [column, row, u, v]
    this.slopes = slopes; // [[u, v] per column, [u, v] per row]
  }

  /** The one that fits best, by least squares; null when the samples lie on one line. */
  static through(samples) {
    const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
    const middle = [0, 1, 2, 3].map((axis) => mean(samples.map((one) => one[axis])));
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

  /** Whether feet lie so far apart across a window that pixels tell both directions. */
  tells(reach) {
    const lengths = this.slopes.map(([u, v]) => Math.hypot(u, v) * reach);
    return Math.min(...lengths) >= TOLD && Math.abs(this._determinant()) * reach * reach >= TOLD * TOLD;
  }

  at(column, row) {
    const [c, r] = [column - this.middle[0], row - this.middle[1]];
    const [x, y] = [0, 1].map((axis) => this.middle[2 + axis] + this.slopes[0][axis] * c + this.slopes[1][axis] * r);
    return { x, y };
  }

  /** [column, row] of a pixel; null where the feet lie on one line. */
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
