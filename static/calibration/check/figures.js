import { spot } from "../../geometry/spatial.js";

/**
 * @typedef {import("../../geometry/camera.js").Camera} Camera
 * @typedef {import("../../geometry/spatial.js").Spot} Spot
 * @typedef {import("./draft.js").Clicks} Clicks
 * @typedef {{residual: number, doubtful: boolean}} ClickFigure
 * @typedef {{spot: Spot|null, views: {[camera: string]: ClickFigure}}} Figures of those views that are calibrated
 * @typedef {{points: number, clicks: number, off: number, median: number|null, p95: number|null,
 *   byCamera: {[camera: string]: number}}} Summary pixels
 */

/** Where the clicks meet, and how far each is off. @param {Clicks} clicks @param {Map<string, Camera>} cameras @returns {Figures} */
export function figuresOf(clicks, cameras) {
  const seen = Object.entries(clicks).flatMap(([name, [u, v]]) => {
    const camera = cameras.get(name);
    return camera ? [{ name, camera, u, v }] : [];
  });
  // In the order of the cameras, so that the same clicks give the same digits.
  seen.sort((one, other) => one.camera.index - other.camera.index);
  const found = spot(seen);
  if (!found) return { spot: null, views: {} };
  const views = seen.map(({ name }, place) => [
    name,
    { residual: found.residuals[place], doubtful: found.doubtful[place] },
  ]);
  return { spot: found, views: Object.fromEntries(views) };
}

/** As the server has it. @param {Figures[]} points @returns {Summary} */
export function summary(points) {
  const placed = points.filter((each) => each.spot);
  /** @type {{[camera: string]: number[]}} */
  const residuals = {};
  for (const { views } of placed)
    for (const [camera, { residual }] of Object.entries(views))
      residuals[camera] = [...(residuals[camera] ?? []), residual];
  const all = Object.values(residuals).flat();
  const byCamera = Object.entries(residuals).map(([camera, values]) => [camera, percentile(values, 0.5)]);
  return {
    points: placed.length,
    clicks: all.length,
    off: placed.reduce((sum, { views }) => sum + Object.values(views).filter(({ doubtful }) => doubtful).length, 0),
    median: all.length ? percentile(all, 0.5) : null,
    p95: all.length ? percentile(all, 0.95) : null,
    byCamera: Object.fromEntries(byCamera),
  };
}

/** Between two values, in proportion. @param {number[]} values @param {number} share */
function percentile(values, share) {
  const sorted = [...values].sort((a, b) => a - b);
  const place = share * (sorted.length - 1);
  const before = Math.floor(place);
  const after = Math.min(before + 1, sorted.length - 1);
  return sorted[before] + (place - before) * (sorted[after] - sorted[before]);
}
