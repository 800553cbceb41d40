import { element } from "../base/dom.js";
import { svg } from "../base/svg.js";

/**
 * @typedef {import("./queue.js").Conflict} Conflict
 * @typedef {import("./queue.js").Picture} Picture
 */

const AROUND = 1.7; // heights of a rectangle that are shown
const SHAPE = 3 / 4; // width to height of a part
const LARGE = 400; // pixels of a rectangle from which the light picture has enough of them

/** A row per view: the same piece of ground, frame after frame. @param {Conflict} conflict @param {string} images */
export function pictures(conflict, images) {
  return conflict.pictures.map((row) => {
    const tall = AROUND * Math.max(...row.flatMap((each) => each.boxes.map(({ box }) => box[3] - box[1])));
    return element("div", { className: "view" }, ...row.map((picture) => part(picture, tall, images)));
  });
}

/** @param {Picture} picture @param {number} tall pixels @param {string} images */
function part(picture, tall, images) {
  const boxes = picture.boxes.map(({ box }) => box);
  const [left, top, right, bottom] = [0, 1, 2, 3].map((side) => {
    const values = boxes.map((box) => box[side]);
    return side < 2 ? Math.min(...values) : Math.max(...values);
  });
  const height = Math.max(tall, AROUND * (bottom - top), (1.2 * (right - left)) / SHAPE);
  const width = height * SHAPE;
  const view = `${(left + right - width) / 2} ${(top + bottom - height) / 2} ${width} ${height}`;
  const href = address(picture, tall, images);
  const drawn = svg(
    "svg",
    { viewBox: view, role: "img", "aria-label": `${picture.camera}, ${picture.frame}` },
    svg("image", { href, width: picture.width, height: picture.height }),
    ...picture.boxes.map(({ side, box: [x, y, end, low] }) =>
      svg("rect", { class: side, x, y, width: end - x, height: low - y }),
    ),
  );
  return element("figure", {}, drawn, element("figcaption", {}, `${picture.camera} · ${picture.frame}`));
}

/** @param {Picture} picture @param {number} tall pixels @param {string} images */
function address(picture, tall, images) {
  return `${images}${tall < AROUND * LARGE ? picture.full : picture.light}.jpg`;
}

/** Begin to fetch what a conflict will show. @param {Conflict} conflict @param {string} images */
export function fetchAhead(conflict, images) {
  for (const row of conflict.pictures) {
    const tall = AROUND * Math.max(...row.flatMap((each) => each.boxes.map(({ box }) => box[3] - box[1])));
    for (const picture of row) new Image().src = address(picture, tall, images);
  }
}
