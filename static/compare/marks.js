import { element } from "../base/dom.js";
import { gettext } from "../base/messages.js";
import { boxBounds, drawBox, drawFoot, drawLabel, drawPath, labelWidth } from "../views/marks.js";
import { HALO, WHITE, YELLOW } from "../views/styles.js";

/**
 * @typedef {import("../geometry/lens.js").XY} XY
 * @typedef {import("../geometry/rectangle.js").Rectangle} Rectangle
 * @typedef {import("../views/pane.js").LaidOutPane} LaidOutPane
 * @typedef {import("./store.js").Kind} Kind
 * @typedef {import("./store.js").Mark} Mark
 * @typedef {import("./store.js").Side} Side
 * @typedef {CanvasRenderingContext2D} Context
 * @typedef {{colour: string, width: number, dash: number[]}} KindLook
 * @typedef {KindLook & {selected: boolean}} Look
 * @typedef {XY & {side: Side}} Foot CSS pixels of the pane
 */

/**
 * How the kinds of people look: colour, line and sign all say the same. Colours lie on photographs, so they
 * are the same in the dark and the light theme.
 * @type {Record<Kind, {sign: string, words: () => string, look: KindLook}>}
 */
export const KINDS = {
  missed: { sign: "×", words: () => gettext("missed"), look: { colour: "#ff8f86", width: 2, dash: [7, 4] } },
  extra: { sign: "+", words: () => gettext("extra"), look: { colour: YELLOW, width: 2, dash: [2, 3] } },
  swapped: { sign: "◆", words: () => gettext("swapped"), look: { colour: "#d3a3ff", width: 2.5, dash: [] } },
  moved: { sign: "→", words: () => gettext("moved"), look: { colour: "#ffb26b", width: 2, dash: [] } },
  matched: { sign: "○", words: () => gettext("matched"), look: { colour: WHITE, width: 1, dash: [] } },
};

/** Mistakes first; who is called moved is the desk's to say. @type {import("./store.js").Counted[]} */
export const ORDER = ["missed", "extra", "swapped", "matched"];

const PLAIN = { box: 1, label: 1 };
const FAINT = { box: 0.6, label: 0.6 }; // who was found asks for no look
const FOOT = 3.5; // CSS pixels
const AROUND = 22; // room a sign with its ring needs around a foot

/**
 * What is drawn of one mark in a pane, or null where neither side is visible.
 * @param {LaidOutPane} pane @param {Mark} mark @param {boolean} selected @param {boolean} labels of all
 */
export function markItem(pane, mark, selected, labels) {
  const { view, transform } = pane;
  const shown = [mark.truth, mark.found].flatMap((side) => {
    const [shape, point] = side ? [view.box(side), view.foot(side)] : [];
    return side && shape && point ? [{ side, shape, point }] : [];
  });
  if (!shown.length) return null;
  const look = { ...KINDS[mark.kind].look, selected };
  const feet = shown.map(({ side, point }) => ({ ...transform.toPane(point.x, point.y), side }));
  const boxed = shown.find(({ side }) => side === mark.shown) ?? shown[0];
  const box = view.index === null ? around(feet) : paneBox(boxed.shape, transform);
  const label = labels || selected ? labelOf(mark, selected) : "";
  return {
    id: mark.key,
    what: mark,
    look: `${mark.kind} ${selected} ${labels}`,
    bounds: boundsOf(box, feet, label),
    /** @param {Context} ctx */
    draw: (ctx) => {
      if (view.index !== null) drawBox(ctx, box, look, label, mark.kind === "matched" && !selected ? FAINT : PLAIN);
      else if (label) drawLabel(ctx, (box.xmin + box.xmax) / 2, box.ymin - 2, label, look);
      drawFeet(ctx, mark, feet, look);
    },
  };
}

/**
 * The sign says the kind, so that labels stay short in a crowd; of a chosen mistake a word says it as well.
 * @param {Mark} mark @param {boolean} selected
 */
function labelOf(mark, selected) {
  const { kind } = mark;
  const number = mark.shown.person;
  if (kind === "matched") return String(number);
  const numbers = kind === "swapped" ? `${mark.before}→${mark.found.person}` : number;
  return `${KINDS[kind].sign} ${numbers}${selected ? ` ${KINDS[kind].words()}` : ""}`;
}

/** @param {Kind} kind */
export function signOf(kind) {
  return element("span", { className: `sign ${kind}`, "aria-hidden": "true" }, KINDS[kind].sign);
}

/**
 * A ring where the truth is, a dot where it was found, a thin line between; a cross or a plus where one lacks.
 * @param {Context} ctx @param {Mark} mark @param {Foot[]} feet @param {Look} look
 */
function drawFeet(ctx, mark, feet, look) {
  if (feet.length === 2) drawPath(ctx, feet, { colour: look.colour, width: 1.25 });
  for (const { x, y, side } of feet) {
    if (mark.kind === "missed") drawCross(ctx, x, y, look.colour, Math.PI / 4);
    else if (mark.kind === "extra") drawCross(ctx, x, y, look.colour, 0);
    else
      drawFoot(ctx, x, y, { ...look, dash: side === mark.truth ? [1] : [] }, side === mark.truth ? FOOT + 1.5 : FOOT);
    if (look.selected) drawRing(ctx, x, y, look.colour);
  }
  if (mark.kind === "swapped") drawDiamond(ctx, feet[0], look.colour);
}

/** @param {Context} ctx @param {number} x @param {number} y @param {string} colour @param {number} angle */
function drawCross(ctx, x, y, colour, angle) {
  const arms = [angle, angle + Math.PI / 2].map((turn) => [7 * Math.cos(turn), 7 * Math.sin(turn)]);
  for (const [dx, dy] of arms) {
    drawPath(
      ctx,
      [
        { x: x - dx, y: y - dy },
        { x: x + dx, y: y + dy },
      ],
      { colour, width: 2.5 },
    );
  }
}

/** @param {Context} ctx @param {XY} foot @param {string} colour */
function drawDiamond(ctx, { x, y }, colour) {
  const points = [
    [0, -8],
    [8, 0],
    [0, 8],
    [-8, 0],
  ].map(([dx, dy]) => ({ x: x + dx, y: y + dy }));
  drawPath(ctx, points, { colour, width: 2, closed: true });
}

/** @param {Context} ctx @param {number} x @param {number} y @param {string} colour */
function drawRing(ctx, x, y, colour) {
  for (const { width, style } of [
    { width: 4, style: HALO },
    { width: 1.5, style: colour },
  ]) {
    ctx.beginPath();
    ctx.arc(x, y, 13, 0, 2 * Math.PI);
    ctx.lineWidth = width;
    ctx.strokeStyle = style;
    ctx.stroke();
  }
}

/** @param {XY[]} feet */
function around(feet) {
  const [xs, ys] = [feet.map(({ x }) => x), feet.map(({ y }) => y)];
  const reach = 10;
  return {
    xmin: Math.min(...xs) - reach,
    ymin: Math.min(...ys) - reach,
    xmax: Math.max(...xs) + reach,
    ymax: Math.max(...ys) + reach,
  };
}

/** @param {Rectangle} box @param {import("../views/transform.js").Transform} transform */
function paneBox(box, transform) {
  const { x: xmin, y: ymin } = transform.toPane(box.xmin, box.ymin);
  const { x: xmax, y: ymax } = transform.toPane(box.xmax, box.ymax);
  return { xmin, ymin, xmax, ymax };
}

/** @param {Rectangle} box @param {XY[]} feet @param {string} label */
function boundsOf(box, feet, label) {
  const bounds = boxBounds(box, label);
  const half = labelWidth(label) / 2;
  for (const { x, y } of feet) {
    bounds.xmin = Math.min(bounds.xmin, x - AROUND, x - half);
    bounds.ymin = Math.min(bounds.ymin, y - AROUND);
    bounds.xmax = Math.max(bounds.xmax, x + AROUND, x + half);
    bounds.ymax = Math.max(bounds.ymax, y + AROUND);
  }
  return bounds;
}
