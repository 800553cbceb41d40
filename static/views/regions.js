/**
 * Rectangles on a pane. Pure.
 * @typedef {{x: number, y: number}} XY
 * @typedef {{width: number, height: number}} Size
 * @typedef {{xmin: number, ymin: number, xmax: number, ymax: number}} Rectangle
 * @typedef {{id: string|number, what: unknown, look: string, bounds: Rectangle}} Shown same `what` and `look` look the same
 * @typedef {Shown & {draw: (ctx: CanvasRenderingContext2D) => void}} Item what is drawn over a picture, in units of the pane
 */

/** @param {Rectangle} one @param {Rectangle} other */
export function overlaps(one, other) {
  return one.xmin < other.xmax && other.xmin < one.xmax && one.ymin < other.ymax && other.ymin < one.ymax;
}

/** @param {Rectangle} box @param {number} x @param {number} y @param {number} [margin] */
export function contains(box, x, y, margin = 0) {
  return x >= box.xmin - margin && x <= box.xmax + margin && y >= box.ymin - margin && y <= box.ymax + margin;
}

/** @param {Rectangle|null} one @param {Rectangle} other @returns {Rectangle} */
export function union(one, other) {
  if (!one) return other;
  return {
    xmin: Math.min(one.xmin, other.xmin),
    ymin: Math.min(one.ymin, other.ymin),
    xmax: Math.max(one.xmax, other.xmax),
    ymax: Math.max(one.ymax, other.ymax),
  };
}

/**
 * What has to be painted again to get from the items `before` to the items `after`; null: nothing.
 * @param {Shown[]} before @param {Shown[]} after @returns {Rectangle|null}
 */
export function damage(before, after) {
  const old = new Map(before.map((item) => [item.id, item]));
  /** @type {Rectangle|null} */
  let dirty = null;
  for (const item of after) {
    const was = old.get(item.id);
    old.delete(item.id);
    if (was && was.what === item.what && was.look === item.look) continue;
    dirty = union(dirty, item.bounds);
    if (was) dirty = union(dirty, was.bounds);
  }
  for (const gone of old.values()) dirty = union(dirty, gone.bounds);
  return dirty;
}
