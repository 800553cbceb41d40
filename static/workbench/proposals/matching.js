/**
 * Which proposals are still open, and who they are. Pure.
 * @typedef {import("../../base/answers.js").Proposed} Proposed
 * @typedef {import("../../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../../truth/annotation.js").People} People
 * @typedef {import("../../truth/propagation.js").XY} XY
 * @typedef {(position: number) => XY} Metres
 */
import { isGuess } from "../../truth/propagation.js";

/** Metres between an annotation, or a refused place, and a proposal of the same person. */
const SAME = 0.35;
const GUESSED = 0.6; // metres that a person carried over may be off

/**
 * Those nobody has looked at: no person of the frame stands there, and nobody said that nobody does. People whom
 * the program carried over explain nothing: they are guesses themselves.
 * @param {Proposed[]} proposed @param {People} people @param {ReadonlySet<number>} refused positions
 * @param {Map<number, number>} known person by track @param {Metres} metres @returns {Proposed[]}
 */
export function openOnes(proposed, people, refused, known, metres) {
  const looked = [...people.values()].filter((one) => !isGuess(one));
  const places = [...looked.map(({ position }) => position), ...refused].map(metres);
  return proposed.filter((one) => {
    const mine = looked.some(({ person }) => person === known.get(one.track));
    return !mine && places.every((place) => apart(place, metres(one.position)) > SAME);
  });
}

/**
 * Whom each proposal is of: the person its track is known as, else somebody carried over who stands near, nearest
 * pairs first. Nobody is two of them; those who are nobody yet are not in the map.
 * @param {Proposed[]} proposed @param {People} people @param {Map<number, number>} known person by track
 * @param {Metres} metres @returns {Map<Proposed, number>}
 */
export function personsOf(proposed, people, known, metres) {
  /** @type {Map<Proposed, number>} */
  const persons = new Map();
  const taken = new Set([...people.values()].filter((one) => !isGuess(one)).map(({ person }) => person));
  for (const one of proposed) {
    const person = known.get(one.track);
    if (person !== undefined && !taken.has(person)) take(one, person);
  }
  for (const { one, person } of pairs(proposed, people, metres)) {
    if (!persons.has(one) && !taken.has(person) && !known.has(one.track)) take(one, person);
  }
  return persons;

  /** @param {Proposed} one @param {number} person */
  function take(one, person) {
    persons.set(one, person);
    taken.add(person);
  }
}

/** @param {Proposed[]} proposed @param {People} people @param {Metres} metres */
function pairs(proposed, people, metres) {
  const guesses = [...people.values()].filter(isGuess);
  return proposed
    .flatMap((one) =>
      guesses.map(({ person, position }) => ({
        one,
        person,
        away: apart(metres(position), metres(one.position)),
      })),
    )
    .filter(({ away }) => away <= GUESSED)
    .sort((first, second) => first.away - second.away);
}

/** @param {XY} one @param {XY} other */
export function apart(one, other) {
  return Math.hypot(one.x - other.x, one.y - other.y);
}
