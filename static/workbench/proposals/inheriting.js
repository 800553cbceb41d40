/**
 * What an annotator has corrected in one frame holds in the others, as long as somebody stands there. Pure.
 * @typedef {import("../../base/answers.js").Proposed} Proposed
 * @typedef {import("./matching.js").XY} XY
 * @typedef {{metres: (position: number) => XY, positionAt: (ground: XY) => number|null}} Ground
 */
import { apart } from "./matching.js";

const STANDS = 0.15; // metres between two proposals of somebody who has not moved: their pictures are alike, and so are the mistakes
const FARTHEST = 0.5; // metres: more than that is no correction, but somebody else

/**
 * A proposal, moved as another one of the same track had to be moved.
 * @param {Proposed} one @param {Proposed} other in another frame @param {number} corrected position there
 * @param {Ground} ground @returns {Proposed} itself where nothing is to be learnt
 */
export function inherited(one, other, corrected, ground) {
  if (other.position === corrected) return one;
  const [here, there, right] = [one.position, other.position, corrected].map((position) => ground.metres(position));
  if (apart(here, there) > STANDS || apart(there, right) > FARTHEST) return one;
  const position = ground.positionAt({ x: here.x + right.x - there.x, y: here.y + right.y - there.y });
  return position === null || position === one.position ? one : { ...one, position };
}
