/** Reads what gtm_hit/geometry/grid_file.py writes: one camera's rectangles of the usual person at every position. */

const MAGIC = "GTMGRID1";
const HEAD = 32; // bytes
const EXCEPTION = 255;

/** @typedef {{columns: number, rows: number, boxes: Int16Array<ArrayBuffer>, feet: Int16Array<ArrayBuffer>|null}} GridFile */

/**
 * @param {ArrayBuffer} buffer the unpacked file
 * @returns {GridFile} `boxes`: xmin, ymin, xmax, ymax
 *   of position 0, then of position 1 …; `feet`: x and y in quarters of a pixel; all 0 where not visible
 */
export function decodeGrid(buffer) {
  const magic = String.fromCharCode(...new Uint8Array(buffer, 0, Math.min(8, buffer.byteLength)));
  if (magic !== MAGIC || buffer.byteLength < HEAD) throw new TypeError("not a grid file");
  const [columns, rows, visible, runCount, exceptionCount, count] = new Uint32Array(buffer, 8, 6);
  const planes = HEAD + 4 * (runCount + exceptionCount);
  if (buffer.byteLength !== planes + count * visible) throw new TypeError("a grid file that is cut off");
  const runs = new Uint32Array(buffer, HEAD, runCount);
  const exceptions = new Uint32Array(buffer, HEAD + 4 * runCount, exceptionCount);
  const boxes = new Int16Array(4 * columns * rows);
  const feet = count === 6 ? new Int16Array(2 * columns * rows) : null;
  let exception = 0;
  const targets = [0, 1, 2, 3].map((number) => ({ values: boxes, width: 4, number }));
  if (feet) targets.push({ values: feet, width: 2, number: 0 }, { values: feet, width: 2, number: 1 });
  targets.forEach((into, number) => {
    const plane = new Uint8Array(buffer, planes + number * visible, visible);
    exception = fill(into, columns, runs, plane, exceptions, exception);
  });
  return { columns, rows, boxes, feet };
}

/**
 * Every `width`-th of the values, from `number` on, out of one plane; returns the next exception.
 * @param {{values: Int16Array, width: number, number: number}} into @param {number} columns of the grid
 * @param {Uint32Array} runs @param {Uint8Array} plane @param {Uint32Array} exceptions @param {number} exception
 */
function fill({ values, width, number }, columns, runs, plane, exceptions, exception) {
  const above = width * columns; // where not visible, and before the first row, there is nothing but 0
  let [position, at] = [0, 0];
  for (let run = 0; run < runs.length; position += runs[run], run += 1) {
    if (run % 2 === 0) continue; // not visible
    for (let one = position; one < position + runs[run]; one += 1, at += 1) {
      const place = width * one + number;
      const known = one > position && one % columns !== 0 ? values[place - width] : (values[place - above] ?? 0);
      const zigzag = plane[at] === EXCEPTION ? exceptions[exception++] : plane[at];
      values[place] = known + ((zigzag >>> 1) ^ -(zigzag & 1));
    }
  }
  return exception;
}
