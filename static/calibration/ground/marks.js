import { svg } from "../../base/svg.js";
import { Camera } from "../../geometry/camera.js";
import { gridLines } from "./grid_lines.js";

export const LONGER = 20; // how much longer than they are residuals are drawn

/**
 * @typedef {import("./store.js").Store} Store
 * @typedef {import("../picture.js").XY} XY
 */

/**
 * What lies over the picture: the ground's grid, clicks with their residuals, and points that are expected.
 * @param {Store} store @param {number} unit pixels of the picture that are one CSS pixel @param {boolean} grid
 */
export function marks(store, unit, grid) {
  const camera = store.camera;
  if (!camera) return [];
  const lines = grid && camera.placed ? gridLines(new Camera(camera.placed), store.ground.points).lines : [];
  const points = store.ground.points.map(({ name }) => point(store, name, unit));
  return [...lines.map((points) => svg("polyline", { class: "ground-line", points })), ...points];
}

/** @param {Store} store @param {string} name @param {number} unit */
function point(store, name, unit) {
  const click = store.clickOf(name);
  const place = click ? { x: click[0], y: click[1] } : store.ghostOf(name);
  if (!place) return svg("g");
  const chosen = name === store.selected;
  const kind = `${click ? "clicked" : "expected"}${chosen ? " chosen" : ""}${isWrong(store, name) ? " wrong" : ""}`;
  const { x, y } = place;
  const words = svg("text", { x: x + 9 * unit, y: y - 9 * unit, "font-size": 13 * unit }, name);
  return svg(
    "g",
    { class: kind, "data-point": name },
    ...(click ? cross(x, y, unit) : circle(x, y, unit)),
    ...arrow(store, name, place),
    words,
  );
}

/** @param {number} x @param {number} y @param {number} unit */
function cross(x, y, unit) {
  const [far, near] = [9 * unit, 2.5 * unit];
  const arms = [
    [-1, 0],
    [1, 0],
    [0, -1],
    [0, 1],
  ];
  return arms.map(([dx, dy]) =>
    svg("line", { x1: x + dx * near, y1: y + dy * near, x2: x + dx * far, y2: y + dy * far }),
  );
}

/** @param {number} x @param {number} y @param {number} unit */
function circle(x, y, unit) {
  return [svg("circle", { cx: x, cy: y, r: 8 * unit }), svg("circle", { class: "dot", cx: x, cy: y, r: 1.2 * unit })];
}

/** From a click towards where the point is expected. @param {Store} store @param {string} name @param {XY} from */
function arrow(store, name, { x, y }) {
  const residual = store.camera.report.residuals?.find((each) => each.name === name);
  if (!store.clickOf(name) || !residual || residual.dx === null || residual.dy === null) return [];
  const longer = residual.used ? LONGER : 1; // one that was left out is far off as it is
  const end = { x2: x - longer * residual.dx, y2: y - longer * residual.dy };
  return [svg("line", { class: "residual", x1: x, y1: y, ...end })];
}

/** Whether a finding names it. @param {Store} store @param {string} name */
export function isWrong(store, name) {
  const residual = store.camera.report.residuals?.find((each) => each.name === name);
  return residual?.used === false || (store.camera.report.findings ?? []).some(({ names }) => names.includes(name));
}
