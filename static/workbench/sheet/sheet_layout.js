/**
 * How large tiles are. Pure.
 * @typedef {{width: number, height: number}} Size CSS pixels
 * @typedef {Size & {columns: number}} Arrangement size of one person's cell
 */
const GAP = 6;
const LEAST = { width: 200, height: 150 }; // smaller than that nobody sees shoes: the sheet scrolls
const MOST = { width: 560, height: 420 };
const SHAPE = 1.5; // width of a cell with two tiles, in heights

/**
 * All cells in sight at once if they may be that small, each as large as possible.
 * @param {number} count @param {Size} room @returns {Arrangement}
 */
export function arrangeCells(count, room) {
  /** @type {(Arrangement & {worth: number})|null} */
  let best = null;
  for (let columns = 1; columns <= Math.max(1, count); columns += 1) {
    const rows = Math.ceil(Math.max(1, count) / columns);
    const width = Math.min(MOST.width, (room.width - GAP * (columns + 1)) / columns);
    const height = Math.min(MOST.height, (room.height - GAP * (rows + 1)) / rows);
    if (width < LEAST.width && columns > 1) break;
    const fits = height >= LEAST.height;
    const shown = fits ? height : LEAST.height;
    const worth = (fits ? 1 : 0) * 1e4 + Math.min(width, shown * SHAPE) + 0.01 * columns;
    if (!best || worth > best.worth) best = { columns, width, height: shown, worth };
  }
  if (!best) throw new RangeError("a sheet has one column at least");
  return { columns: best.columns, width: Math.floor(best.width), height: Math.floor(best.height) };
}
