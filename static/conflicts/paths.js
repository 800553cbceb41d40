import { svg } from "../base/svg.js";

/**
 * @typedef {import("./queue.js").Conflict} Conflict
 * @typedef {import("./queue.js").Place} Place
 */

const MARGIN = 1; // metres around everything
const LEAST = 4; // metres across

/** Both ways seen from above, Y upwards, with a line per metre. @param {Conflict} conflict */
export function paths(conflict) {
  const own = [...conflict.before, ...conflict.after];
  const xs = own.map(({ x }) => x);
  const ys = own.map(({ y }) => -y);
  const middle = [xs, ys].map((values) => (Math.min(...values) + Math.max(...values)) / 2);
  const across = [xs, ys].map((values) => Math.max(...values) - Math.min(...values));
  const size = Math.max(...across, LEAST) + 2 * MARGIN;
  const [left, top] = middle.map((value) => value - size / 2);
  return svg(
    "svg",
    { viewBox: `${left} ${top} ${size} ${size}`, role: "img" },
    ...metres(left, top, size),
    ...conflict.others.map((path) => line(path, "other", size)),
    between(conflict),
    line(conflict.before, "before", size),
    line(conflict.after, "after", size),
  );
}

/** @param {number} left @param {number} top @param {number} size */
function metres(left, top, size) {
  const lines = [];
  for (let x = Math.ceil(left); x < left + size; x += 1)
    lines.push(svg("line", { class: "grid", x1: x, x2: x, y1: top, y2: top + size }));
  for (let y = Math.ceil(top); y < top + size; y += 1)
    lines.push(svg("line", { class: "grid", x1: left, x2: left + size, y1: y, y2: y }));
  const words = svg("text", { x: left + size / 50, y: top + size * 0.98, "font-size": size / 26 }, "1 m grid");
  return [...lines, words];
}

/** @param {Place[]} path @param {string} name @param {number} size */
function line(path, name, size) {
  const points = path.map(({ x, y }) => `${x},${-y}`).join(" ");
  const dots = path.map(({ frame, x, y }) =>
    svg("circle", { class: name, cx: x, cy: -y, r: size / 160 }, svg("title", {}, String(frame))),
  );
  const end = name === "before" ? path.at(-1) : path[0];
  const ends =
    end && name !== "other"
      ? [
          svg("circle", { class: name, cx: end.x, cy: -end.y, r: size / 70 }),
          svg(
            "text",
            { x: end.x + size / 40, y: -end.y + (name === "before" ? -1 : 2) * (size / 45), "font-size": size / 24 },
            String(end.frame),
          ),
        ]
      : [];
  return svg("g", {}, svg("polyline", { class: name, points }), ...dots, ...ends);
}

/** @param {Conflict} conflict */
function between({ before, after }) {
  const [left, came] = [before.at(-1), after[0]];
  if (!left || !came) return svg("g");
  return svg("line", { class: "between", x1: left.x, y1: -left.y, x2: came.x, y2: -came.y });
}
