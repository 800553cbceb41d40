/** Where people's feet are in a picture, by the table of a camera, and which are nearest to a pixel. Pure. */

const CELL = 8; // pixels along each side of a bucket

/**
 * @typedef {{boxes: Int16Array, feet: Int16Array, width: number, height: number}} Feet see grid_file.js; `width` and
 *   `height` of the picture
 * @typedef {{starts: Uint32Array<ArrayBuffer>, members: Uint32Array<ArrayBuffer>}} FootIndex positions, bucket by bucket
 */

/**
 * Pixel x of the foot of whoever stands on a visible position.
 * @param {Feet} table @param {number} position
 */
export function footX({ feet }, position) {
  return feet[2 * position] / 4;
}

/** @param {Feet} table @param {number} position */
export function footY({ feet }, position) {
  return feet[2 * position + 1] / 4;
}

/** @param {Feet} table @param {number} position */
export function isVisible({ boxes }, position) {
  return boxes[4 * position + 2] > 0;
}

/** Buckets of the positions whose foot is inside the picture. @param {Feet} table @returns {FootIndex} */
export function indexFeet(table) {
  const across = Math.ceil(table.width / CELL);
  const count = table.boxes.length / 4;
  const cells = new Int32Array(count).fill(-1);
  const starts = new Uint32Array(across * Math.ceil(table.height / CELL) + 1);
  for (let position = 0; position < count; position += 1) {
    if (!isVisible(table, position)) continue;
    const [x, y] = [footX(table, position), footY(table, position)];
    if (x < 0 || y < 0 || x >= table.width || y >= table.height) continue;
    cells[position] = Math.floor(y / CELL) * across + Math.floor(x / CELL);
    starts[cells[position] + 1] += 1;
  }
  for (let cell = 1; cell < starts.length; cell += 1) starts[cell] += starts[cell - 1];
  const members = new Uint32Array(starts[starts.length - 1]);
  const next = starts.slice();
  for (let position = 0; position < count; position += 1) {
    if (cells[position] >= 0) members[next[cells[position]]++] = position;
  }
  return { starts, members };
}

/**
 * The visible position whose foot is nearest to a pixel.
 *
 * @param {Feet} table @param {FootIndex} index
 * @param {number} x @param {number} y @param {number} reach pixels
 * @returns {number|null} null when there is none within reach
 */
export function nearestFoot(table, index, x, y, reach) {
  const across = Math.ceil(table.width / CELL);
  const down = Math.ceil(table.height / CELL);
  const [column, row] = [Math.floor(x / CELL), Math.floor(y / CELL)];
  /** @type {number|null} */
  let found = null;
  let best = reach * reach;
  for (let ring = 0; ring * CELL <= Math.sqrt(best) + CELL; ring += 1) {
    for (let r = Math.max(row - ring, 0); r <= Math.min(row + ring, down - 1); r += 1) {
      const whole = Math.abs(r - row) === ring;
      for (let c = column - ring; c <= column + ring; c += whole || ring === 0 ? 1 : 2 * ring) {
        if (c < 0 || c >= across) continue;
        for (let at = index.starts[r * across + c]; at < index.starts[r * across + c + 1]; at += 1) {
          const position = index.members[at];
          const apart = (footX(table, position) - x) ** 2 + (footY(table, position) - y) ** 2;
          if (apart < best || (apart === best && found === null)) [found, best] = [position, apart];
        }
      }
    }
  }
  return found;
}
