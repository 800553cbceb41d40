/**
 * The positions people can stand on. A position's id is `row * columns + column`; columns run along x.
 * @typedef {{columns: number, rows: number, step: number, origin: number[]}} GridJSON metres
 */
export class Grid {
  /** @param {GridJSON} json */
  constructor({ columns, rows, step, origin }) {
    this.columns = columns;
    this.rows = rows;
    this.step = step;
    this.origin = origin;
    this.count = columns * rows;
    this.extent = [columns * step, rows * step];
  }

  /**
   * Ground point of a position, metres.
   * @param {number} position
   */
  metres(position) {
    const [column, row] = [position % this.columns, Math.floor(position / this.columns)];
    return {
      x: this.origin[0] + (column * this.extent[0]) / this.columns,
      y: this.origin[1] + (row * this.extent[1]) / this.rows,
    };
  }

  /**
   * Nearest position of a ground point; -1 more than half a step outside the grid.
   * @param {number} x @param {number} y metres
   */
  position(x, y) {
    const [column, row] = [this._cell(x, 0), this._cell(y, 1)];
    const inside = column >= 0 && row >= 0 && column < this.columns && row < this.rows;
    return inside ? row * this.columns + column : -1;
  }

  /**
   * Nearest position of a ground point, wherever that is; -1 only for NaN.
   * @param {number} x @param {number} y metres
   */
  nearest(x, y) {
    const column = Math.min(Math.max(this._cell(x, 0), 0), this.columns - 1);
    const row = Math.min(Math.max(this._cell(y, 1), 0), this.rows - 1);
    return Number.isNaN(column + row) ? -1 : row * this.columns + column;
  }

  /** @param {number} position */
  contains(position) {
    return position >= 0 && position < this.count;
  }

  /** @param {number} metres @param {0|1} axis */
  _cell(metres, axis) {
    return Math.floor((metres - this.origin[axis]) / this.step + 0.5);
  }
}
