/**
 * @typedef {import("../../base/answers.js").Proposed} Proposed
 * @typedef {import("../../views/pane.js").LaidOutPane} LaidOutPane
 * @typedef {import("../../views/regions.js").Item} Item
 * @typedef {import("../../views/regions.js").XY} XY
 * @typedef {import("../../views/transform.js").Transform} Transform
 * @typedef {import("../../views/styles.js").Style} Style
 */
import { gettext } from "../../base/messages.js";
import { readoutItem } from "../../views/hints_on_ground.js";
import { boxBounds, drawBox, drawFoot } from "../../views/marks.js";
import { contains } from "../../views/regions.js";
import { apart } from "./matching.js";

const COLOUR = "#a6ff9a";
const FOOT = 10; // CSS pixels around a foot point that mean it
const DOT = 4; // CSS pixels on the map
const SURE = 0.8; // of the score

/**
 * Always dashed, whoever is proposed. The better the score, the heavier the line and the longer its dashes.
 * @param {Proposed} one @param {number} threshold @param {boolean} focused @returns {Style}
 */
function styleOf({ score }, threshold, focused) {
  const [width, dash] = score < threshold ? [1, [2, 4]] : score < SURE ? [1.75, [6, 4]] : [2.75, [11, 4]];
  return { colour: COLOUR, width, dash, selected: focused };
}

/**
 * Items for `Panes.addExtra`: everybody who is proposed and not looked at.
 * @param {import("./proposals.js").Proposals} proposals @param {LaidOutPane} pane @returns {Item[]}
 */
export function proposalItems(proposals, pane) {
  return proposals.open.flatMap((one) => item(proposals, one, pane) ?? []);
}

/** @param {import("./proposals.js").Proposals} proposals @param {Proposed} one @param {LaidOutPane} pane @returns {Item|null} */
function item(proposals, one, { view, transform }) {
  const seen = view.box(one);
  if (!seen) return null;
  const focused = proposals.focus === one;
  const style = styleOf(one, proposals.threshold, focused);
  const [first, last] = [transform.toPane(seen.xmin, seen.ymin), transform.toPane(seen.xmax, seen.ymax)];
  const box = { xmin: first.x, ymin: first.y, xmax: last.x, ymax: last.y };
  const label = view.index !== null && (focused || one.score < SURE) ? percent(one.score) : ""; // the sure ones are many
  return {
    id: `proposal ${one.id}`,
    what: one,
    look: `${style.width} ${focused}`,
    bounds: boxBounds(box, label),
    draw: (ctx) => {
      if (view.index !== null) return drawBox(ctx, box, style, label);
      drawFoot(ctx, (box.xmin + box.xmax) / 2, (box.ymin + box.ymax) / 2, style, DOT + style.width);
    },
  };
}

/**
 * The proposal a place of a pane is about: the nearest foot, else the box that stands in front. Null: none.
 * @param {Proposed[]} open @param {LaidOutPane} pane @param {XY} at CSS pixels @returns {Proposed|null}
 */
export function proposalAt(open, pane, at) {
  const foot = nearestFoot(open, pane, at);
  if (foot) return foot;
  const { x, y } = pane.transform.toSource(at.x, at.y);
  const inside = open.flatMap((one) => {
    const box = pane.view.box(one);
    return box && contains(box, x, y) ? [{ one, front: box.ymax }] : [];
  });
  return inside.sort((one, other) => other.front - one.front)[0]?.one ?? null;
}

/**
 * The one whose feet are there.
 * @param {Proposed[]} open @param {LaidOutPane} pane @param {XY} at CSS pixels @returns {Proposed|null}
 */
export function nearestFoot(open, pane, at) {
  const near = open.flatMap((one) => {
    const foot = pane.view.box(one) && pane.view.foot(one);
    const away = foot ? apart(pane.transform.toPane(foot.x, foot.y), at) : FOOT + 1;
    return away <= FOOT ? [{ one, away }] : [];
  });
  return near.sort((one, other) => one.away - other.away)[0]?.one ?? null;
}

/**
 * What speaks for a proposal, at the pointer.
 * @param {Proposed} one @param {number|null} person @param {LaidOutPane} pane @param {XY} at @returns {Item}
 */
export function evidenceItem(one, person, pane, at) {
  return readoutItem(`evidence ${one.id}`, pane.room, at, evidenceWords(one, person), COLOUR);
}

/** @param {Proposed} one @param {number|null} person */
export function evidenceWords(one, person) {
  const who = person === null ? gettext("somebody new") : gettext("person {person}", { person });
  const words = [gettext("proposed: {who}, {percent}", { who, percent: percent(one.score) })];
  if (one.filled) words.push(gettext("seen before and after, not in this frame"));
  if (one.seated) words.push(gettext("seems to be sitting"));
  const boxed = one.evidence.filter(({ box }) => box);
  const hidden = one.evidence.filter(({ box, hidden }) => !box && hidden);
  const not = one.evidence.filter(({ box, hidden, seen }) => !box && !hidden && (seen ?? 1) < 0.5);
  const background = one.evidence.filter(({ box, hidden, seen }) => !box && !hidden && seen !== null && seen >= 0.5);
  if (boxed.length) words.push(gettext("found in {views}", { views: names(boxed) }));
  if (background.length) words.push(gettext("differs from the background in {views}", { views: names(background) }));
  if (hidden.length) words.push(gettext("hidden in {views}", { views: names(hidden) }));
  if (not.length) words.push(gettext("not seen in {views}", { views: names(not) }));
  return words;
}

/** @param {{camera: string}[]} evidence */
function names(evidence) {
  return evidence.map(({ camera }) => camera).join(", ");
}

/** @param {number} score */
export function percent(score) {
  return `${Math.round(100 * score)} %`;
}
