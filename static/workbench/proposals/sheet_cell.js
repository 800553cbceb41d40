/**
 * One person of a frame on a small canvas: on the left all of them, on the right their feet, as large as a click needs.
 * @typedef {import("../../truth/scene.js").Scene} Scene
 * @typedef {import("../../views/pane.js").Placed} Placed
 * @typedef {import("../../views/regions.js").Rectangle} Rectangle
 * @typedef {import("../../views/regions.js").XY} XY
 * @typedef {import("../../views/styles.js").Style} Style
 * @typedef {{xmin: number, ymin: number, width: number, height: number}} Part of a picture, its pixels
 */
import { contextOf, drawBox, drawFoot } from "../../views/marks.js";

const WHOLE = 0.36; // of the cell's width
const FEET = 0.42; // of the person's height, that the feet's part shows
const AIR = 1.2; // height of what shows all of somebody, in heights of the person
const STEP = 0.05; // metres, for how exact a click is

/**
 * The view in which a click on the feet is most exact on the ground, of those that show them; first of those that a
 * detector found them in. Null: no view shows the feet.
 * @param {Scene} scene @param {Placed} one @param {ReadonlySet<string>} found names of cameras
 */
export function clearestView(scene, one, found) {
  const spreads = scene.cameras.map(({ name }, view) => ({
    view,
    spread: spread(scene, view, one) * (found.has(name) ? 1 : 4),
  }));
  const best = spreads.reduce((first, other) => (other.spread < first.spread ? other : first));
  return Number.isFinite(best.spread) ? best.view : null;
}

/** Metres on the ground that a pixel is, about. @param {Scene} scene @param {number} view @param {Placed} one */
function spread(scene, view, one) {
  const { x, y } = scene.metres(one.position);
  const [at, right, up] = [
    { x, y },
    { x: x + STEP, y },
    { x, y: y + STEP },
  ].map((place) => scene.toImage(view, place));
  const { width, height } = scene.cameras[view];
  if (!at || !right || !up || !scene.rectangles(one)[view]) return Infinity;
  if (at.x < 0 || at.y < 0 || at.x >= width || at.y >= height) return Infinity;
  const [a, b, c, d] = [right.x - at.x, up.x - at.x, right.y - at.y, up.y - at.y];
  return (STEP * Math.hypot(a, b, c, d)) / Math.abs(a * d - b * c);
}

/**
 * What of the picture the two parts show; the feet stay where they were when the cell was made, or cells would jump.
 * @param {Rectangle} box @param {XY} foot @param {number} width @param {number} height of the cell
 */
export function partsOf(box, foot, width, height) {
  const tall = box.ymax - box.ymin;
  const [left, right] = [Math.round(width * WHOLE), width - Math.round(width * WHOLE)];
  const whole = around((box.xmin + box.xmax) / 2, (box.ymin + box.ymax) / 2, AIR * tall, left / height);
  const feet = around(foot.x, foot.y - 0.25 * FEET * tall, FEET * tall, right / height);
  return { whole, feet, left };
}

/** @param {number} x @param {number} y @param {number} height @param {number} aspect @returns {Part} */
function around(x, y, height, aspect) {
  const width = height * aspect;
  return { xmin: x - width / 2, ymin: y - height / 2, width, height };
}

/**
 * @param {HTMLCanvasElement} canvas @param {{picture: ImageBitmap|null, scale: number}} shown `scale`: of the picture
 * @param {ReturnType<typeof partsOf>} parts @param {{box: Rectangle, foot: XY, style: Style}} mark
 */
export function paintCell(canvas, { picture, scale }, { whole, feet, left }, { box, foot, style }) {
  const ctx = contextOf(canvas);
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  const ratio = canvas.width / width;
  ctx.setTransform(ratio, 0, 0, ratio, 0, 0);
  ctx.clearRect(0, 0, width, height);
  for (const { part, x, across } of [
    { part: whole, x: 0, across: left },
    { part: feet, x: left, across: width - left },
  ]) {
    const zoom = height / part.height;
    /** @param {XY} at */
    const place = (at) => ({ x: x + (at.x - part.xmin) * zoom, y: (at.y - part.ymin) * zoom });
    ctx.save();
    ctx.beginPath();
    ctx.rect(x, 0, across - 1, height);
    ctx.clip();
    if (picture) {
      const from = [part.xmin, part.ymin, part.width, part.height].map((side) => side * scale);
      ctx.drawImage(picture, from[0], from[1], from[2], from[3], x, 0, across, height);
    }
    const [low, high] = [place({ x: box.xmin, y: box.ymin }), place({ x: box.xmax, y: box.ymax })];
    drawBox(ctx, { xmin: low.x, ymin: low.y, xmax: high.x, ymax: high.y }, style, "");
    ctx.setLineDash([]);
    const at = place(foot);
    if (part === feet) drawFoot(ctx, at.x, at.y, style, 4);
    ctx.restore();
  }
}
