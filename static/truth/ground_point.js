/**
 * What is to be said about a place on the ground before somebody is put there. Pure.
 * @typedef {{x: number, y: number}} XY metres
 * @typedef {import("./annotation.js").Annotation} Annotation
 * @typedef {import("./scene.js").Scene} Scene
 * @typedef {import("./store.js").Store} Store
 * @typedef {object} GroundPoint
 * @property {XY|null} ground
 * @property {number|null} position
 * @property {Annotation|null} occupant
 * @property {number|null} border metres inside the border, negative outside
 * @property {"horizon"|"outside"|"occupied"|null} problem
 */
import { gettext } from "../base/messages.js";

const NEAR = 0.5; // metres from the border that are worth a word

/**
 * @param {Scene} scene @param {Store} store
 * @param {XY|null} ground null above the horizon
 * @param {number|null} except
 * @returns {GroundPoint}
 */
export function spotOn(scene, store, ground, except = null) {
  if (!ground) return { ground, position: null, occupant: null, border: null, problem: "horizon" };
  const position = scene.positionAt(ground);
  const border = insideBy(scene.grid, ground);
  if (position === null) return { ground, position, occupant: null, border, problem: "outside" };
  const occupant = store.occupant(position, except);
  return { ground, position, occupant, border, problem: occupant ? "occupied" : null };
}

/**
 * Metres inside the border of the grid; negative outside.
 * @param {import("../geometry/grid.js").Grid} grid @param {XY} ground
 */
export function insideBy({ origin, extent, step }, { x, y }) {
  const [dx, dy] = [x - origin[0] + step / 2, y - origin[1] + step / 2]; // half a step around the outermost positions
  const inside = Math.min(dx, dy, extent[0] - dx, extent[1] - dy);
  if (inside >= 0) return inside;
  return -Math.hypot(Math.max(-dx, dx - extent[0], 0), Math.max(-dy, dy - extent[1], 0));
}

/**
 * The lines beside the pointer: where it is, and what there is to say about it.
 * @param {Scene} scene @param {GroundPoint} spot
 * @param {boolean} byTable a view that knows no horizon, only whose feet are where
 */
export function spotWords(scene, spot, byTable = false) {
  if (!spot.ground) return [byTable ? gettext("no feet in the ground area") : gettext("above the horizon")];
  const { x, y } = spot.position === null ? spot.ground : scene.metres(spot.position);
  const where = gettext("x {x}  y {y} m", { x: x.toFixed(3), y: y.toFixed(3) });
  const remark = spotRemark(spot);
  return remark ? [where, remark] : [where];
}

/** @param {GroundPoint} spot */
function spotRemark({ problem, occupant, border }) {
  if (border === null) return null;
  if (problem === "outside")
    return gettext("{metres} m outside the ground area", { metres: Math.max(-border, 0.01).toFixed(2) });
  if (occupant) return gettext("person {person} stands exactly here", { person: occupant.person });
  if (border < NEAR) return gettext("{metres} m to the border", { metres: border.toFixed(2) });
  return null;
}
