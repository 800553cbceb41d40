/** Reads what gtm_hit/geometry/grid_file.py writes: one camera's rectangles of the usual person at every position. */

const MAGIC = "GTMGRID1";
const HEAD = 32; // bytes
const EXCEPTION = 255;

/**
 * @param {ArrayBuffer} buffer the unpacked file
 * @returns {{columns: number, rows: number, boxes: Int16Array}} `boxes`: xmin, ymin, xmax, ymax of position 0, then
 *   of position 1 …; all 0 where not visible
 */
export function decodeGrid(buffer) {
  const magic = String.fromCharCode(...new Uint8Array(buffer, 0, Math.min(8, buffer.byteLength)));
  if (magic !== MAGIC || buffer.byteLength < HEAD) throw new TypeError("not a grid file");
  const [columns, rows, visible, runCount, exceptionCount] = new Uint32Array(buffer, 8, 5);
  const planes = HEAD + 4 * (runCount + exceptionCount);
  if (buffer.byteLength !== planes + 4 * visible) throw new TypeError("a grid file that is cut off");
  const runs = new Uint32Array(buffer, HEAD, runCount);
  const exceptions = new Uint32Array(buffer, HEAD + 4 * runCount, exceptionCount);
  const boxes = new Int16Array(4 * columns * rows);
  let exception = 0;
  for (let side = 0; side < 4; side += 1) {
    const plane = new Uint8Array(buffer, planes + side * visible, visible);
    exception = fillSide(boxes, side, columns, runs, plane, exceptions, exception);
  }
  return { columns, rows, boxes };
}

/** One side of all boxes; returns the next exception. */
function fillSide(boxes, side, columns, runs, plane, exceptions, exception) {
  const above = 4 * columns; // where not visible, and before the first row, there is nothing but 0
  let [position, at] = [0, 0];
  for (let run = 0; run < runs.length; position += runs[run], run += 1) {
    if (run % 2 === 0) continue; // not visible
    for (let one = position; one < position + runs[run]; one += 1, at += 1) {
      const place = 4 * one + side;
      const known = one > position && one % columns !== 0 ? boxes[place - 4] : (boxes[place - above] ?? 0);
      const zigzag = plane[at] === EXCEPTION ? exceptions[exception++] : plane[at];
      boxes[place] = known + ((zigzag >>> 1) ^ -(zigzag & 1));
    }
  }
  return exception;
}
