/**
 * One view of one person, close up: how the picture lies in the tile, and what is drawn over it.
 * @typedef {import("../../truth/scene.js").Scene} Scene
 * @typedef {import("../../views/pane.js").Placed} Placed
 * @typedef {import("../../views/regions.js").Rectangle} Rectangle
 * @typedef {import("../../views/styles.js").Style} Style
 * @typedef {import("./fused_foot.js").XY} XY
 * @typedef {import("./fused_foot.js").Seeing} Seeing
 * @typedef {{x: number, y: number, width: number, height: number}} Area CSS pixels of the cell's canvas
 * @typedef {{view: number, foot: XY, density: number}} Anchor what the middle of a tile shows, in pixels of the picture;
 *   `density`: of these pixels per metre of the person's height
 */
import { cropAround } from "../../views/crops.js";
import { drawBox, drawFoot, drawLabel, drawPath } from "../../views/marks.js";
import { HALO } from "../../views/styles.js";
import { Transform } from "../../views/transform.js";

const SHOWN = 0.75; // metres of somebody's height that a tile shows
const GROUND = 0.66; // of a tile's height, where the feet are
const LARGEST = 10; // CSS pixels per pixel of the picture
const SLACK = 0.12; // of a tile: a foot nearer to its border is brought to the middle again
const RING = 0.05; // metres around the foot that are near enough
const WHOLE = 0.42; // of a tile's height: the whole person in its corner
const [AROUND, SLIM] = [24, 0.42];

/** @param {Scene} scene @param {Placed} placed @param {number} view @returns {Anchor|null} */
export function anchorOf(scene, placed, view) {
  const box = scene.rectangles(placed)[view];
  const foot = scene.toImage(view, scene.metres(placed.position));
  if (!box || !foot) return null;
  return { view, foot, density: (box.ymax - box.ymin) / scene.cylinderOf(placed).height };
}

/**
 * Pixels of the picture → CSS pixels. All tiles show metres alike.
 * @param {Anchor} anchor @param {Area} area
 */
export function transformIn({ foot, density }, { x, y, width, height }) {
  const scale = Math.min(LARGEST, height / SHOWN / density);
  return new Transform(scale, x + width / 2 - foot.x * scale, y + GROUND * height - foot.y * scale);
}

/** @param {Transform} transform @param {Area} area @param {XY} foot pixels of the picture */
export function isInside(transform, { x, y, width, height }, foot) {
  const at = transform.toPane(foot.x, foot.y);
  const across = Math.abs(at.x - x - width / 2) < (0.5 - SLACK) * width;
  return across && at.y > y + SLACK * height && at.y < y + (1 - SLACK) * height;
}

/**
 * @typedef {object} Painting
 * @property {Scene} scene
 * @property {Transform} transform
 * @property {Area} area
 * @property {number} view
 * @property {ImageBitmap|null} picture
 * @property {Placed} placed
 * @property {Style} style
 * @property {boolean} whole whether the whole person stands in the corner
 */

/** @param {CanvasRenderingContext2D} ctx @param {Painting} painting */
export function paintTile(ctx, painting) {
  const { scene, transform, area, view, picture, placed, style } = painting;
  ctx.save();
  ctx.beginPath();
  ctx.rect(area.x, area.y, area.width, area.height);
  ctx.clip();
  ctx.fillStyle = "rgb(72, 80, 88)";
  ctx.fillRect(area.x, area.y, area.width, area.height);
  if (picture) paintPicture(ctx, scene.cameras[view], transform, area, picture);
  const box = scene.rectangles(placed)[view];
  if (box) drawBox(ctx, onTile(box, transform), style, "");
  ring(scene, view, scene.metres(placed.position), transform).forEach((line) =>
    drawPath(ctx, line, { colour: style.colour, width: 1.25, closed: true }),
  );
  const foot = scene.toImage(view, scene.metres(placed.position));
  if (foot) {
    const at = transform.toPane(foot.x, foot.y);
    drawFoot(ctx, at.x, at.y, { colour: style.colour, dash: [] }, 1.5);
  }
  if (painting.whole && box && picture) paintWhole(ctx, painting, box, picture);
  drawLabel(ctx, area.x + AROUND, area.y + area.height - 3, scene.cameras[view].name, { ...style, selected: false });
  ctx.restore();
}

/**
 * @param {CanvasRenderingContext2D} ctx @param {{width: number}} camera @param {Transform} transform @param {Area} area
 * @param {ImageBitmap} picture
 */
function paintPicture(ctx, camera, transform, { x, y, width, height }, picture) {
  const ratio = picture.width / camera.width;
  const from = transform.toSource(x, y);
  const [across, down] = [width / transform.scale, height / transform.scale];
  ctx.drawImage(picture, from.x * ratio, from.y * ratio, across * ratio, down * ratio, x, y, width, height);
}

/** @param {CanvasRenderingContext2D} ctx @param {Painting} painting @param {Rectangle} box @param {ImageBitmap} picture */
function paintWhole(ctx, { scene, area, view, style }, box, picture) {
  const height = Math.round(WHOLE * area.height);
  const width = Math.round(SLIM * height);
  const [x, y] = [area.x + 3, area.y + 3];
  const crop = cropAround(box, SLIM);
  const ratio = picture.width / scene.cameras[view].width;
  const zoom = height / crop.height;
  ctx.fillStyle = HALO;
  ctx.fillRect(x - 1, y - 1, width + 2, height + 2);
  ctx.save();
  ctx.beginPath();
  ctx.rect(x, y, width, height);
  ctx.clip();
  const source = [crop.x, crop.y, crop.width, crop.height].map((value) => value * ratio);
  ctx.drawImage(picture, source[0], source[1], source[2], source[3], x, y, width, height);
  ctx.setLineDash([]);
  ctx.lineWidth = 1;
  ctx.strokeStyle = style.colour;
  const corner = [x + (box.xmin - crop.x) * zoom, y + (box.ymin - crop.y) * zoom];
  ctx.strokeRect(corner[0], corner[1], (box.xmax - box.xmin) * zoom, (box.ymax - box.ymin) * zoom);
  ctx.restore();
}

/**
 * The ground around a foot that is near enough, as a view shows it.
 * @param {Pick<Seeing, "toImage">} scene @param {number} view @param {XY} at metres @param {Transform} transform
 * @returns {XY[][]} one line; none where the view does not show all of it
 */
export function ring(scene, view, { x, y }, transform) {
  const seen = Array.from({ length: AROUND }, (_, index) => {
    const angle = (2 * Math.PI * index) / AROUND;
    return scene.toImage(view, { x: x + RING * Math.cos(angle), y: y + RING * Math.sin(angle) });
  });
  const line = seen.flatMap((one) => (one ? [transform.toPane(one.x, one.y)] : []));
  return line.length === AROUND ? [line] : [];
}

/** @param {Rectangle} box @param {Transform} transform */
function onTile(box, transform) {
  const [first, last] = [transform.toPane(box.xmin, box.ymin), transform.toPane(box.xmax, box.ymax)];
  return { xmin: first.x, ymin: first.y, xmax: last.x, ymax: last.y };
}
