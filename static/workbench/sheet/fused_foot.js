/**
 * Where somebody stands, by what was known of them and by clicks on their feet. Pure.
 *
 * One view tells well to which side somebody stands and badly how far away; what was known before tells both alike.
 * So a click settles the direction in which it is sure, and the other one stays as near to what was known as the pixel
 * leaves open.
 * @typedef {{x: number, y: number}} XY metres, or image pixels
 * @typedef {{toImage: (view: number, ground: XY) => XY|null, toGround: (view: number, pixel: XY) => XY|null}} Seeing
 * @typedef {{view: number, pixel: XY, sigma: number}} Click `sigma`: image pixels it may be off along each axis
 * @typedef {XY & {sigma: number}} Known metres it may be off along each axis
 * @typedef {{xx: number, xy: number, yy: number, x: number, y: number}} Normal equations of least squares
 */
const ROUNDS = 12;
const FREEDOM = 3; // degrees of freedom: somebody can be much farther off than is usual
const BESIDE = 0.01; // metres by which slopes are measured

/**
 * @param {Seeing} scene @param {Known} known @param {Click[]} clicks at least one
 * @returns {XY|null} metres; null: a click is above the horizon
 */
export function footFrom(scene, known, clicks) {
  const grounds = clicks.map(({ view, pixel }) => scene.toGround(view, pixel));
  if (grounds.some((one) => one === null)) return null;
  /** @type {XY} */
  let at = { x: known.x, y: known.y };
  for (let round = 0; round < ROUNDS; round += 1) {
    const step = stepFrom(scene, known, clicks, at);
    if (!step) return grounds.at(-1) ?? null;
    at = { x: at.x + step.x, y: at.y + step.y };
  }
  return at;
}

/**
 * The farther away somebody turns out to be, the less was known (Student's distribution).
 * @param {Seeing} scene @param {Known} known @param {Click[]} clicks @param {XY} at @returns {XY|null}
 */
function stepFrom(scene, known, clicks, at) {
  /** @type {Normal} */
  const sum = { xx: 0, xy: 0, yy: 0, x: 0, y: 0 };
  const far = Math.hypot(known.x - at.x, known.y - at.y) / known.sigma;
  const sigma = known.sigma * Math.sqrt((FREEDOM + far ** 2) / (FREEDOM + 2));
  add(sum, { x: 1, y: 0 }, known.x - at.x, sigma);
  add(sum, { x: 0, y: 1 }, known.y - at.y, sigma);
  for (const { view, pixel, sigma } of clicks) {
    const slopes = slopesAt(scene, view, at);
    if (!slopes) return null;
    add(sum, slopes.u, pixel.x - slopes.seen.x, sigma);
    add(sum, slopes.v, pixel.y - slopes.seen.y, sigma);
  }
  const determinant = sum.xx * sum.yy - sum.xy * sum.xy;
  if (!(determinant > 1e-9)) return null;
  return {
    x: (sum.yy * sum.x - sum.xy * sum.y) / determinant,
    y: (sum.xx * sum.y - sum.xy * sum.x) / determinant,
  };
}

/** @param {Normal} sum @param {XY} slope @param {number} miss @param {number} sigma */
function add(sum, { x, y }, miss, sigma) {
  const weight = 1 / sigma ** 2;
  sum.xx += weight * x * x;
  sum.xy += weight * x * y;
  sum.yy += weight * y * y;
  sum.x += weight * x * miss;
  sum.y += weight * y * miss;
}

/**
 * Image pixels per metre at a ground point, of both axes of the picture; null where a view does not show it.
 * @param {Pick<Seeing, "toImage">} scene @param {number} view @param {XY} at metres
 * @returns {{seen: XY, u: XY, v: XY}|null}
 */
export function slopesAt(scene, view, { x, y }) {
  const [seen, east, north] = [
    { x, y },
    { x: x + BESIDE, y },
    { x, y: y + BESIDE },
  ].map((ground) => scene.toImage(view, ground));
  if (!seen || !east || !north) return null;
  return {
    seen,
    u: { x: (east.x - seen.x) / BESIDE, y: (north.x - seen.x) / BESIDE },
    v: { x: (east.y - seen.y) / BESIDE, y: (north.y - seen.y) / BESIDE },
  };
}
