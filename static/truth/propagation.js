/**
 * Which people a frame starts with. Pure: maps, seconds and a grid in, annotations out.
 * @typedef {import("./annotation.js").Annotation} Annotation
 * @typedef {import("./annotation.js").People} People
 * @typedef {import("../geometry/grid.js").Grid} Grid
 * @typedef {{x: number, y: number}} XY metres
 * @typedef {{time: number} & XY} Seen
 * @typedef {{time: number, people: People}} Moment seconds, and who is where
 */
import { annotation, CARRIED } from "./annotation.js";

// Fitted to the first 100 of 200 frames of real people, tried on the others. Left to be pressed there: 21.1 positions a
// person after copying, 10.0 after the last step alone, 8.4 after this.
const DAMPING = 0.93; // of every further step: who walks may stop
const OLDER = 0.8; // weight of a step against the one after it; many even out how exactly one clicked
const STANDS = 0.2; // m/s; slower than that nobody walks, the clicks differ
const FASTEST = 3; // m/s; faster than that nobody walked, somebody was mixed up
const LOOK_BACK = 4; // frames a movement is read from

/**
 * Put there by the program, and not looked at since.
 * @param {Annotation} one
 */
export function isGuess({ state, origin }) {
  return state === CARRIED && (origin === "carried" || origin === "interpolated");
}

/**
 * The people of the first source, moved on the way they walked; who has no known movement stays where he was.
 * Works forwards and backwards, and never puts two people on one position.
 * @param {Grid} grid
 * @param {number} time seconds, of the frame to fill
 * @param {Moment[]} sources frames on one side of it, nearest first
 * @param {{except?: People, origin?: string}} [options] `except`: who is there already
 */
export function predictPeople(grid, time, sources, { except = new Map(), origin = "carried" } = {}) {
  const taken = new Set([...except.values()].map(({ position }) => position));
  return [...(sources[0]?.people.values() ?? [])]
    .filter(({ person }) => !except.has(person))
    .map((one) => {
      const position = freePosition(grid, expected(grid, time, sources, one.person), taken);
      taken.add(position);
      return annotation({ ...one, position, state: CARRIED, origin });
    });
}

/**
 * The position nearest to a ground point (metres) that nobody has taken; clamped to the grid.
 * @param {Grid} grid @param {XY} ground @param {Set<number>} taken
 */
export function freePosition(grid, { x, y }, taken) {
  const wanted = grid.nearest(x, y);
  if (!taken.has(wanted)) return wanted;
  const [column, row] = [wanted % grid.columns, Math.floor(wanted / grid.columns)];
  for (let ring = 1; ring < Math.max(grid.columns, grid.rows); ring += 1) {
    const free = ringAround(grid, column, row, ring).filter((position) => !taken.has(position));
    if (free.length) return nearestTo(grid, { x, y }, free);
  }
  return wanted;
}

/**
 * Where a person is at `time`, metres.
 * @param {Grid} grid @param {number} time @param {Moment[]} sources @param {number} person
 * @returns {XY}
 */
function expected(grid, time, sources, person) {
  const seen = sources
    .flatMap(({ time, people }) => {
      const one = people.get(person);
      return one ? [{ time, ...grid.metres(one.position) }] : [];
    })
    .slice(0, LOOK_BACK);
  const [last] = seen;
  const velocity = velocityOf(seen);
  if (!velocity) return last;
  const interval = last.time - seen[1].time;
  const reach = interval * dampedSteps((time - last.time) / interval);
  return { x: last.x + velocity.x * reach, y: last.y + velocity.y * reach };
}

/**
 * m/s out of the places where somebody was, nearest first; null when that is not known, cannot be, or is no walk.
 * @param {Seen[]} seen @returns {XY|null}
 */
function velocityOf(seen) {
  const all = seen.slice(1).map((older, index) => step(older, seen[index]));
  const mixedUp = all.findIndex((one) => speed(one) > FASTEST);
  const steps = mixedUp < 0 ? all : all.slice(0, mixedUp);
  const total = steps.reduce((sum, _, index) => sum + OLDER ** index, 0);
  /** @param {"x"|"y"} axis */
  const mean = (axis) => steps.reduce((sum, one, index) => sum + OLDER ** index * one[axis], 0) / total;
  const velocity = { x: mean("x"), y: mean("y") };
  return steps.length && speed(velocity) >= STANDS ? velocity : null;
}

/** @param {Seen} from @param {Seen} to @returns {XY} */
function step(from, to) {
  const seconds = to.time - from.time;
  return { x: (to.x - from.x) / seconds, y: (to.y - from.y) / seconds };
}

/** @param {XY} velocity */
function speed({ x, y }) {
  return Math.hypot(x, y);
}

/**
 * d + d² + … + dⁿ, also for an n that is not whole.
 * @param {number} n
 */
function dampedSteps(n) {
  return (DAMPING * (1 - DAMPING ** n)) / (1 - DAMPING);
}

/** @param {Grid} grid @param {number} column @param {number} row @param {number} ring */
function ringAround(grid, column, row, ring) {
  /** @type {number[]} */
  const positions = [];
  for (let dy = -ring; dy <= ring; dy += 1) {
    for (let dx = -ring; dx <= ring; dx += Math.abs(dy) === ring ? 1 : 2 * ring) {
      const [c, r] = [column + dx, row + dy];
      if (c >= 0 && r >= 0 && c < grid.columns && r < grid.rows) positions.push(r * grid.columns + c);
    }
  }
  return positions;
}

/** @param {Grid} grid @param {XY} ground @param {number[]} positions */
function nearestTo(grid, { x, y }, positions) {
  /** @param {number} position */
  const distance = (position) => Math.hypot(grid.metres(position).x - x, grid.metres(position).y - y);
  return positions.reduce((best, one) => (distance(one) < distance(best) ? one : best));
}
