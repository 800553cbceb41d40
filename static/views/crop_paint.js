/**
 * One person cut out of one picture, with the box around.
 * @typedef {import("./pane.js").Person} Person
 * @typedef {object} Cell where to, CSS pixels, and of which camera
 * @property {number} x
 * @property {number} y
 * @property {number} width
 * @property {number} height
 * @property {number} view
 * @property {ImageBitmap|null} picture
 */
import { cropAround } from "./crops.js";
import { LOOKS, lookOf } from "./styles.js";

const MISSING = LOOKS.ghost; // where a person would be looked for

/**
 * @param {CanvasRenderingContext2D} ctx @param {import("../truth/scene.js").Scene} scene @param {Cell} cell
 * @param {Person|null|undefined} one whom @param {boolean} here whether that is where they were annotated
 */
export function paintCrop(ctx, scene, cell, one, here) {
  const { x, y, width, height, view, picture } = cell;
  const box = one && scene.rectangles(one)[view];
  ctx.fillStyle = "rgba(127, 140, 152, 0.16)";
  ctx.fillRect(x, y, width, height);
  if (!box) return;
  const crop = cropAround(box, width / height);
  ctx.save();
  ctx.beginPath();
  ctx.rect(x, y, width, height);
  ctx.clip();
  if (picture) {
    const scale = picture.width / scene.cameras[view].width;
    ctx.drawImage(
      picture,
      crop.x * scale,
      crop.y * scale,
      crop.width * scale,
      crop.height * scale,
      x,
      y,
      width,
      height,
    );
  }
  const zoom = height / crop.height;
  const look = here ? lookOf(one, false) : MISSING;
  ctx.setLineDash(look.dash);
  ctx.lineWidth = 1;
  ctx.strokeStyle = look.colour;
  ctx.strokeRect(
    x + (box.xmin - crop.x) * zoom,
    y + (box.ymin - crop.y) * zoom,
    (box.xmax - box.xmin) * zoom,
    (box.ymax - box.ymin) * zoom,
  );
  ctx.restore();
}
