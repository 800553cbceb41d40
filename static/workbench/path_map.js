import { element } from "./dom.js";
import { drawFoot, drawPath } from "./marks.js";
import { MapView } from "./map_view.js";
import { fit } from "./transform.js";

const SIZE = { width: 420, height: 170 }; // CSS pixels

/**
 * A small map with paths on it, for showing what a command will do.
 * @param {{positions: number[], look: object}[]} paths dots along a line, in the given look of looks.js
 */
export function pathMap(scene, mapColours, paths, label) {
  const ratio = window.devicePixelRatio || 1;
  const canvas = element("canvas", { className: "path-map", width: SIZE.width * ratio, height: SIZE.height * ratio, role: "img", "aria-label": label });
  const view = new MapView(scene, "");
  const transform = fit(view.size, SIZE);
  const ctx = canvas.getContext("2d");
  ctx.scale(ratio, ratio);
  view.paintBackground(ctx, transform, null, { mapColours });
  for (const { positions, look } of paths) {
    const points = positions.map((position) => view.point(scene.metres(position))).map(({ x, y }) => transform.toPane(x, y));
    drawPath(ctx, points, { colour: look.colour, dash: look.dash });
    for (const { x, y } of points) drawFoot(ctx, x, y, look, 2.5);
  }
  return canvas;
}
