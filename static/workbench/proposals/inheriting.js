/**
 * What the frames beside one say about somebody who is proposed there. Pure.
 * @typedef {import("../../base/answers.js").Proposed} Proposed
 * @typedef {import("./matching.js").XY} XY
 * @typedef {{metres: (position: number) => XY, positionAt: (ground: XY) => number|null}} Ground
 * @typedef {{proposal: Proposed, marked: number|null}} Beside the same track in another frame; `marked`: the position
 *   that an annotator has validated there
 */
import { apart } from "./matching.js";

// Metres. Two proposals so near show somebody who has not moved: their pictures are alike, and so are the mistakes.
const STANDS = 0.15;
const FARTHEST = 0.5; // more than that is no correction, but somebody else
const UNLIKE = 0.3; // from the proposal: the track does not go straight on, or is of two people
// How far off places are along each axis: proposals, validated ones, the middle of two steps of real walkers.
const [PROPOSED, MARKED, WALK] = [0.055, 0.025, 0.06];

/**
 * Somebody stands: a proposal is moved as the other one had to be moved.
 * @param {Proposed} one @param {Beside} beside @param {Ground} ground
 * @returns {Proposed|null} null: that is nothing to go by
 */
export function standing(one, { proposal, marked }, ground) {
  if (marked === null) return null;
  const [here, there, right] = [one.position, proposal.position, marked].map((position) => ground.metres(position));
  if (apart(here, there) > STANDS || apart(there, right) > FARTHEST) return null;
  return movedTo(one, { x: here.x + right.x - there.x, y: here.y + right.y - there.y }, ground);
}

/**
 * Somebody walks: between a proposal and the middle of the places just before and after it, as each of them is sure.
 * @param {Proposed} one @param {Beside} before @param {Beside} after @param {Ground} ground @returns {Proposed}
 */
export function walking(one, before, after, ground) {
  const [here, from, to] = [one.position, placeOf(before), placeOf(after)].map((position) => ground.metres(position));
  const middle = { x: (from.x + to.x) / 2, y: (from.y + to.y) / 2 };
  if (apart(here, middle) > UNLIKE) return one;
  const variance = (sigmaOf(before) ** 2 + sigmaOf(after) ** 2) / 4 + WALK ** 2;
  const share = PROPOSED ** 2 / (PROPOSED ** 2 + variance);
  const at = { x: here.x + share * (middle.x - here.x), y: here.y + share * (middle.y - here.y) };
  return movedTo(one, at, ground);
}

/** @param {Beside} beside */
function placeOf({ proposal, marked }) {
  return marked ?? proposal.position;
}

/** @param {Beside} beside */
function sigmaOf({ marked }) {
  return marked === null ? PROPOSED : MARKED;
}

/** @param {Proposed} one @param {XY} at @param {Ground} ground @returns {Proposed} */
function movedTo(one, at, ground) {
  const position = ground.positionAt(at);
  return position === null || position === one.position ? one : { ...one, position };
}
