import { epipolarLine } from "../../geometry/epipolar.js";
import { pixelEllipse } from "../../geometry/pixel_ellipse.js";
import { shown } from "../../geometry/spatial.js";

/**
 * @typedef {import("../picture.js").XY} XY
 * @typedef {import("../../geometry/camera.js").Camera} Camera
 * @typedef {{from: string, points: XY[], doubtful: boolean}} Line on which lies what was clicked in `from`
 * @typedef {object} Seen what one view shows of the thing
 * @property {XY|null} click
 * @property {boolean} doubtful its click is beyond 3 σ
 * @property {number|null} residual pixels
 * @property {XY|null} place where the thing must be
 * @property {import("../../geometry/pixel_ellipse.js").Ellipse|null} ellipse ± one σ of that
 * @property {boolean} inside whether the picture shows that place
 * @property {Line[]} lines
 */

/** @param {import("./store.js").Store} store @param {string} name of the camera @returns {Seen} */
export function seenIn(store, name) {
  const { clicks, figures, cameras } = store;
  const camera = cameras.get(name);
  const { spot, views } = figures;
  const place = camera && spot ? shown(camera, spot.point) : null;
  const click = clicks[name];
  return {
    click: click ? { x: click[0], y: click[1] } : null,
    doubtful: views[name]?.doubtful ?? false,
    residual: views[name]?.residual ?? null,
    place,
    ellipse: camera && spot && place ? pixelEllipse(camera, spot.point, spot.covariance) : null,
    inside: Boolean(camera && place && isInside(camera, place)),
    lines: camera ? lines(store, camera) : [],
  };
}

/** @param {import("./store.js").Store} store @param {Camera} camera */
function lines({ clicks, figures, cameras }, camera) {
  return Object.entries(clicks).flatMap(([from, [u, v]]) => {
    const other = cameras.get(from);
    if (!other || from === camera.name) return [];
    const points = epipolarLine({ camera: other, u, v }, camera);
    return points.length ? [{ from, points, doubtful: figures.views[from]?.doubtful ?? false }] : [];
  });
}

/** @param {Camera} camera @param {XY} place */
function isInside({ width, height }, { x, y }) {
  return x >= -0.5 && y >= -0.5 && x < width - 0.5 && y < height - 0.5;
}
