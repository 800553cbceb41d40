import { svg } from "../../base/svg.js";

/**
 * @typedef {import("./seen.js").Seen} Seen
 * @typedef {import("./seen.js").Line} Line
 * @typedef {import("../picture.js").XY} XY
 */

const FAR = 3; // pictures away from which on a line is not drawn

/**
 * What lies over one view: lines of the other views' clicks, where the thing must be with its ±, and the click.
 * @param {Seen} seen @param {{width: number, height: number}} size of the picture
 * @param {number} unit pixels of the picture that are one CSS pixel @param {boolean} lines whether they are drawn
 */
export function marks({ click, doubtful, place, ellipse, lines: all, residual }, size, unit, lines) {
  const near = place && Math.abs(place.x) < FAR * size.width && Math.abs(place.y) < FAR * size.height ? place : null;
  return [
    ...(lines ? all.flatMap((line) => polyline(line, size, near !== null, unit)) : []),
    ...(near ? [expected(near, ellipse, unit)] : []),
    ...(click ? [clicked(click, near, doubtful, residual, unit)] : []),
  ];
}

/** @param {Line} line @param {{width: number, height: number}} size @param {boolean} faint @param {number} unit */
function polyline({ from, points, doubtful }, { width, height }, faint, unit) {
  const inside = points.filter(({ x, y }) => x >= 0 && y >= 0 && x < width && y < height);
  const near = points.filter(({ x, y }) => Math.abs(x) < FAR * width && Math.abs(y) < FAR * height);
  if (near.length < 2) return [];
  const text = near.map(({ x, y }) => `${x.toFixed(2)},${y.toFixed(2)}`).join(" ");
  const kind = `epipolar${faint ? " faint" : ""}${doubtful ? " doubtful" : ""}`;
  const at = faint && !doubtful ? undefined : inside[Math.floor(inside.length / 2)];
  const words = at
    ? [svg("text", { class: kind, x: at.x + 6 * unit, y: at.y - 6 * unit, "font-size": 11 * unit }, from)]
    : [];
  return [svg("polyline", { class: kind, points: text, "data-from": from }), ...words];
}

/** @param {XY} place @param {Seen["ellipse"]} ellipse @param {number} unit */
function expected({ x, y }, ellipse, unit) {
  const around = ellipse
    ? svg("ellipse", {
        rx: Math.max(ellipse.major, unit),
        ry: Math.max(ellipse.minor, unit),
        transform: `translate(${x} ${y}) rotate(${ellipse.turn})`,
      })
    : null;
  const arms = cross(x, y, 3 * unit, 9 * unit);
  return svg("g", { class: "meeting", "data-x": x, "data-y": y }, ...arms, ...(around ? [around] : []));
}

/**
 * @param {XY} click @param {XY|null} place @param {boolean} doubtful @param {number|null} residual @param {number} unit
 */
function clicked({ x, y }, place, doubtful, residual, unit) {
  const side = 9 * unit;
  // A square besides the colour: not everybody sees red.
  const shape = doubtful
    ? [svg("rect", { x: x - side, y: y - side, width: 2 * side, height: 2 * side })]
    : [svg("circle", { cx: x, cy: y, r: 7 * unit })];
  const away = place ? [svg("line", { class: "residual", x1: x, y1: y, x2: place.x, y2: place.y })] : [];
  const words = residual === null ? "" : `${residual.toFixed(1)} px`;
  return svg(
    "g",
    { class: `seen-click${doubtful ? " doubtful" : ""}` },
    ...shape,
    ...away,
    svg("circle", { class: "dot", cx: x, cy: y, r: 1.2 * unit }),
    svg("text", { x: x + 11 * unit, y: y - 8 * unit, "font-size": 12 * unit }, words),
  );
}

/** @param {number} x @param {number} y @param {number} near @param {number} far */
function cross(x, y, near, far) {
  const arms = [
    [-1, -1],
    [1, -1],
    [-1, 1],
    [1, 1],
  ];
  return arms.map(([dx, dy]) =>
    svg("line", { x1: x + dx * near, y1: y + dy * near, x2: x + dx * far, y2: y + dy * far }),
  );
}
