import { element } from "../base/dom.js";
import { unit } from "../base/scale.js";
import { MapView } from "./map_view.js";
import { contextOf, drawFoot, drawPath } from "./marks.js";
import { clamped, focus } from "./transform.js";

const SIZE = { width: 420, height: 170 }; // CSS pixels
const SHARE = 0.75; // of the map that the paths fill
const LARGEST = 60; // CSS pixels per metre

/**
 * A small map with paths on it, for showing what a command will do.
 * @param {import("../truth/scene.js").Scene} scene @param {import("./display.js").MapColours} mapColours
 * @param {{positions: number[], look: {colour: string, dash: number[]}}[]} paths dots along a line, in the given look
 * @param {string} label of the picture, for screen readers
 */
export function pathMap(scene, mapColours, paths, label) {
  const ratio = (window.devicePixelRatio || 1) * unit();
  const canvas = element("canvas", {
    className: "path-map",
    width: SIZE.width * ratio,
    height: SIZE.height * ratio,
    role: "img",
    "aria-label": label,
  });
  const view = new MapView(scene, "");
  const points = paths.map(({ positions }) => positions.map((position) => view.point(scene.metres(position))));
  const transform = clamped(focus(around(points.flat()), SIZE, SHARE, LARGEST), view.size, SIZE, LARGEST);
  const ctx = contextOf(canvas);
  ctx.scale(ratio, ratio);
  view.paintBackground(ctx, transform, null, { mapColours });
  paths.forEach(({ look }, index) => {
    const places = points[index].map(({ x, y }) => transform.toPane(x, y));
    drawPath(ctx, places, { colour: look.colour, dash: look.dash });
    for (const { x, y } of places) drawFoot(ctx, x, y, look, 2.5);
  });
  return canvas;
}

/** @param {import("./regions.js").XY[]} points */
function around(points) {
  const [xs, ys] = [points.map(({ x }) => x), points.map(({ y }) => y)];
  return { xmin: Math.min(...xs), ymin: Math.min(...ys), xmax: Math.max(...xs), ymax: Math.max(...ys) };
}
