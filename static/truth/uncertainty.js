/**
 * How far a click in one view can be off on the ground, and which other view would settle it. Pure.
 * @typedef {import("./scene.js").Scene} Scene
 * @typedef {{x: number, y: number}} XY
 * @typedef {object} ShownView what a pane knows of its view
 * @property {{index: number|null, size: {width: number, height: number}}} view `index`: of the camera; null: the map
 * @property {{toPane: (x: number, y: number) => XY}|null} transform
 * @property {{width: number, height: number}} room
 * @typedef {[number, number, number]} Information inverse covariance xx, xy, yy, 1/m²
 */
const MISS = 3; // image pixels: shoes are blurred and half hidden, however large the picture is shown
const WORTH = 0.1; // metres of doubt that are worth a second click
const BETTER = 0.5; // of the doubt that may be left after it

/**
 * @template {ShownView} Pane
 * @param {Scene} scene @param {Pane[]} panes @param {Pane} pane
 * @param {XY} ground metres @param {number} z metres above it of what is clicked on
 * @returns {{metres: number, settles: Pane|null}} standard deviation along the worst direction, and the pane in
 *   which one click more would leave least of it; null when one click is enough, or no other view helps
 */
export function uncertaintyAt(scene, panes, pane, ground, z) {
  const own = information(scene, pane, ground, z);
  if (!own) return { metres: 0, settles: null };
  const metres = worst(own);
  if (metres < WORTH) return { metres, settles: null };
  /** @type {{left: number, settles: Pane|null}} */
  let best = { left: BETTER * metres, settles: null };
  for (const other of panes) {
    const more = other !== pane && information(scene, other, ground, 0);
    const left = more ? worst(sum(own, more)) : Infinity;
    if (left < best.left) best = { left, settles: other };
  }
  return { metres, settles: best.settles };
}

/**
 * What a click in a pane says about the ground: the inverse covariance [xx, xy, yy], 1/m²; null where it is not seen.
 * @param {Scene} scene @param {ShownView} pane @param {XY} ground @param {number} z @returns {Information|null}
 */
function information(scene, { view, transform, room }, { x, y }, z) {
  const { index } = view;
  if (index === null || !transform) return null;
  /** @param {number} dx @param {number} dy */
  const seen = (dx, dy) => scene.toImage(index, { x: x + dx, y: y + dy }, z);
  const [foot, east, north] = [seen(0, 0), seen(0.01, 0), seen(0, 0.01)];
  if (!foot || !east || !north || !isShown(foot, view, transform, room)) return null;
  const spread = 0.01 * MISS;
  const [a, b] = [(east.x - foot.x) / spread, (north.x - foot.x) / spread];
  const [c, d] = [(east.y - foot.y) / spread, (north.y - foot.y) / spread];
  return [a * a + c * c, a * b + c * d, b * b + d * d];
}

/**
 * @param {XY} at @param {ShownView["view"]} view @param {NonNullable<ShownView["transform"]>} transform @param {ShownView["room"]} room
 */
function isShown({ x, y }, { size }, transform, room) {
  const at = transform.toPane(x, y);
  const inPicture = x >= 0 && y >= 0 && x < size.width && y < size.height;
  return inPicture && at.x >= 0 && at.y >= 0 && at.x < room.width && at.y < room.height;
}

/** @param {Information} one @param {Information} other @returns {Information} */
function sum(one, other) {
  return [one[0] + other[0], one[1] + other[1], one[2] + other[2]];
}

/**
 * Standard deviation along the least certain direction, metres.
 * @param {Information} information
 */
function worst([xx, xy, yy]) {
  const least = (xx + yy) / 2 - Math.hypot((xx - yy) / 2, xy);
  return 1 / Math.sqrt(Math.max(least, 1e-12));
}
