/**
 * Which two views tell best where somebody's feet are. Pure.
 * @typedef {import("./fused_foot.js").XY} XY
 * @typedef {import("../../views/pane.js").Placed} Placed
 * @typedef {import("../../views/regions.js").Rectangle} Rectangle
 * @typedef {object} Scene
 * @property {{name: string, width: number, height: number}[]} cameras
 * @property {(placed: Placed) => (Rectangle|null)[]} rectangles
 * @property {(position: number) => XY} metres
 * @property {(view: number, ground: XY) => XY|null} toImage
 * @typedef {Pick<import("../../base/answers.js").Evidence, "box"|"hidden">} Seen what a program says of a view
 * @typedef {[number, number, number]} Information inverse covariance xx, xy, yy, 1/m²
 */
import { slopesAt } from "./fused_foot.js";

const EDGE = 6; // image pixels from the picture's border, nearer than which feet are cut off
const HIDDEN = 0.15; // what a view is worth in which somebody nearer hides the feet
const UNSEEN = 0.4; // … in which a program that looked there found nobody
const GUESS = 100; // 1/m²: what is known without any view, to 10 cm

/**
 * The best one first, then the one that tells most of what that one leaves open. Feet that nobody hides come before
 * hidden ones; where no view shows feet there is nobody to be shown.
 * @param {Scene} scene @param {Placed} one @param {Placed[]} others who may stand in front
 * @param {Map<string, Seen>} [evidence] by camera, if a program looked
 * @param {number} [count] views, at most @returns {number[]} indices
 */
export function tileViews(scene, one, others, evidence = new Map(), count = 2) {
  const known = scene.cameras
    .map(({ name }, view) => ({ view, told: informationOf(scene, view, one, others, evidence.get(name)) }))
    .flatMap(({ view, told }) => (told ? [{ view, told }] : []));
  /** @type {number[]} */
  const chosen = [];
  /** @type {Information} */
  let sum = [GUESS, 0, GUESS];
  while (chosen.length < count && chosen.length < known.length) {
    const left = known.filter(({ view }) => !chosen.includes(view));
    const best = left.reduce((first, other) =>
      spread(plus(sum, other.told)) < spread(plus(sum, first.told)) ? other : first,
    );
    chosen.push(best.view);
    sum = plus(sum, best.told);
  }
  return chosen;
}

/**
 * @param {Scene} scene @param {number} view @param {Placed} one @param {Placed[]} others @param {Seen} [evidence]
 * @returns {Information|null}
 */
function informationOf(scene, view, one, others, evidence) {
  const box = scene.rectangles(one)[view];
  const slopes = box && slopesAt(scene, view, scene.metres(one.position));
  if (!box || !slopes) return null;
  const { seen, u, v } = slopes;
  const { width, height } = scene.cameras[view];
  if (seen.x < EDGE || seen.y < EDGE || seen.x > width - EDGE || seen.y > height - EDGE) return null;
  const hidden = evidence?.hidden || hides(scene, view, seen, box, others);
  const worth = (hidden ? HIDDEN : evidence && !evidence.box ? UNSEEN : 1) ** 2;
  return [worth * (u.x * u.x + v.x * v.x), worth * (u.x * u.y + v.x * v.y), worth * (u.y * u.y + v.y * v.y)];
}

/**
 * Whether somebody who stands nearer to the camera covers the feet.
 * @param {Scene} scene @param {number} view @param {XY} foot @param {Rectangle} own @param {Placed[]} others
 */
function hides(scene, view, foot, own, others) {
  return others.some((other) => {
    const box = scene.rectangles(other)[view];
    if (!box || box.ymax <= own.ymax) return false;
    return foot.x > box.xmin && foot.x < box.xmax && foot.y > box.ymin;
  });
}

/** @param {Information} one @param {Information} other @returns {Information} */
function plus(one, other) {
  return [one[0] + other[0], one[1] + other[1], one[2] + other[2]];
}

/** The sum of both variances, m². @param {Information} information */
function spread([xx, xy, yy]) {
  return (xx + yy) / (xx * yy - xy * xy);
}
