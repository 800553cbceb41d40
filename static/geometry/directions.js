/**
 * Which way on the ground is Left, Right, Up, Down on the screen.
 * @typedef {import("./camera.js").AnyCamera} AnyCamera
 * @typedef {{columns: number, rows: number}} Step
 * @typedef {"left"|"right"|"up"|"down"} Key
 * @typedef {Record<Key, Step>} Axes what each arrow key does
 * @typedef {Step & import("./lens.js").XY} ScreenStep with its direction on the screen
 */
import { project } from "./camera.js";

const REACH = 0.05; // metres to either side from which a direction is measured

/**
 * Left, Right, Up, Down as unit vectors on the screen, where y points down.
 * @type {[Key, number, number][]}
 */
const KEYS = [
  ["left", -1, 0],
  ["right", 1, 0],
  ["up", 0, -1],
  ["down", 0, 1],
];

/** The eight ways to lay the ground's axes on the screen's: a quarter turn, maybe mirrored. */
const LAYOUTS = [
  [1, 0],
  [-1, 0],
  [0, 1],
  [0, -1],
].flatMap(([columns, rows]) => [
  layout({ columns, rows }, { columns: -rows, rows: columns }),
  layout({ columns, rows }, { columns: rows, rows: -columns }),
]);

/**
 * Where the four steps on the ground lead on the screen, seen at a ground point.
 *
 * @param {AnyCamera} camera @param {number} x @param {number} y
 * @returns {ScreenStep[]|null} one unit vector (x, y) in pixels for
 *   each of +column, -column, +row, -row; null where the point is not in front of the camera
 */
export function screenStep(camera, x, y) {
  const alongColumns = direction(camera, x, y, REACH, 0);
  const alongRows = direction(camera, x, y, 0, REACH);
  if (!alongColumns || !alongRows) return null;
  /** @type {ScreenStep[]} */
  const steps = [];
  for (const sign of [1, -1])
    steps.push({ columns: sign, rows: 0, x: sign * alongColumns.x, y: sign * alongColumns.y });
  for (const sign of [1, -1]) steps.push({ columns: 0, rows: sign, x: sign * alongRows.x, y: sign * alongRows.y });
  return steps;
}

/**
 * What each arrow key does at a ground point: the layout whose four steps together come closest to the keys, so
 * every step has one key and opposite keys undo each other.
 *
 * @param {AnyCamera} camera @param {number} x @param {number} y
 * @returns {Axes|null} null where the point is not in front
 */
export function screenAxes(camera, x, y) {
  const steps = screenStep(camera, x, y);
  if (!steps) return null;
  const scores = LAYOUTS.map((candidate) => agreement(candidate, steps));
  return LAYOUTS[scores.indexOf(Math.max(...scores))];
}

/** @param {Step} right @param {Step} up @returns {Axes} */
function layout(right, up) {
  /** @param {Step} step */
  const opposite = ({ columns, rows }) => ({ columns: 0 - columns, rows: 0 - rows });
  return { left: opposite(right), right, up, down: opposite(up) };
}

/**
 * Sum of the cosines between keys and the steps they make.
 * @param {Axes} candidate @param {ScreenStep[]} steps
 */
function agreement(candidate, steps) {
  return KEYS.reduce((sum, [key, keyX, keyY]) => {
    const { columns, rows } = candidate[key];
    const step = steps.find((each) => each.columns === columns && each.rows === rows);
    return step ? sum + keyX * step.x + keyY * step.y : sum;
  }, 0);
}

/** @param {AnyCamera} camera @param {number} x @param {number} y @param {number} reachX @param {number} reachY */
function direction(camera, x, y, reachX, reachY) {
  if (camera.byTable) return camera.direction(x, y, reachX ? 0 : 1);
  const [before, after] = [project(camera, x - reachX, y - reachY), project(camera, x + reachX, y + reachY)];
  if (!before || !after) return null;
  const [right, down] = [after.x - before.x, after.y - before.y];
  const length = Math.hypot(right, down);
  return length > 0 ? { x: right / length, y: down / length } : null;
}
