/** Which arrow keys bring somebody near enough to the truth with the fewest presses. */

export const NEAR = 0.05; // metres from the truth that are near enough
const FAR = 10; // positions a step with Shift goes

/**
 * The shortest way between two positions of the ground grid: how many presses, and the first of them.
 * @param {{columns: number, rows: number, step: number}} grid
 * @param {number} from @param {number} to
 * @param {{mayFar: boolean, isOccupied: (position: number) => boolean}} rules
 */
export function shortestWay({ columns, rows, step }, from, to, { mayFar, isOccupied }) {
  const [x0, y0] = [from % columns, Math.floor(from / columns)];
  const [dx, dy] = [(to % columns) - x0, Math.floor(to / columns) - y0];
  const inside = {
    x: (cells) => x0 + cells >= 0 && x0 + cells < columns,
    y: (cells) => y0 + cells >= 0 && y0 + cells < rows,
  };
  const reach = Math.floor(NEAR / step + 1e-9);
  let best = { cost: Infinity };
  for (let i = -reach; i <= reach; i += 1) {
    for (let j = -reach; j <= reach; j += 1) {
      if (Math.hypot(i, j) > reach || isOccupied(to - i - j * columns)) continue;
      const [x, y] = [presses(dx - i, mayFar, inside.x), presses(dy - j, mayFar, inside.y)];
      if (x.cost + y.cost < best.cost) best = { cost: x.cost + y.cost, x, y };
    }
  }
  const along = best.x.cost ? "x" : "y";
  const { sign, far } = best[along];
  return { cost: best.cost, along, sign, far };
}

/** Presses along one axis, coarse ones first: {cost, sign and far of the next one}. */
function presses(cells, mayFar, inside) {
  const far = Math.trunc(cells / FAR);
  const coarse = mayFar ? [0, far, far + Math.sign(cells)].filter((steps) => inside(FAR * steps)) : [0];
  const options = coarse.map((steps) => ({
    steps,
    rest: cells - FAR * steps,
    cost: Math.abs(steps) + Math.abs(cells - FAR * steps),
  }));
  const best = options.reduce((one, other) => (other.cost < one.cost ? other : one));
  return { cost: best.cost, far: best.steps !== 0, sign: Math.sign(best.steps || best.rest) };
}
