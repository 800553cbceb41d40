/**
 * Three-way merge of one frame, per person. Pure: maps person → annotation in, a new map out.
 * A person only one side changed is taken from that side. Both sides added the same number for different
 * positions: two different people, ours is listed in `renumber`. Everything else both changed differently is a
 * conflict, in which `people` keeps ours until the annotator decides.
 * @typedef {import("./annotation.js").Annotation} Annotation
 * @typedef {import("./annotation.js").People} People
 * @typedef {Annotation|null|undefined} Perhaps
 * @typedef {{person: number, base: Annotation|undefined, ours: Annotation|undefined, theirs: Annotation|undefined}} Conflict
 * @param {People} base @param {People} ours @param {People} theirs
 * @returns {{people: People, conflicts: Conflict[], renumber: number[]}}
 */
export function mergePeople(base, ours, theirs) {
  /** @type {People} */
  const people = new Map();
  /** @type {Conflict[]} */
  const conflicts = [];
  /** @type {number[]} */
  const renumber = [];
  for (const person of new Set([...base.keys(), ...ours.keys(), ...theirs.keys()])) {
    const [was, mine, other] = [base.get(person), ours.get(person), theirs.get(person)];
    if (same(mine, other) || same(other, was)) put(people, person, mine);
    else if (same(mine, was)) put(people, person, other);
    else if (was === undefined && mine && other && mine.position !== other.position) {
      people.set(person, other);
      renumber.push(person);
    } else if (was === undefined && mine && other) put(people, person, mine);
    else {
      put(people, person, mine);
      conflicts.push({ person, base: was, ours: mine, theirs: other });
    }
  }
  return { people, conflicts, renumber };
}

/**
 * A flag only one side changed follows that side; both changed means both set it to the same value.
 * @param {boolean} base @param {boolean} ours @param {boolean} theirs
 */
export function mergeFlag(base, ours, theirs) {
  return ours !== base ? ours : theirs;
}

const SAVED = /** @type {const} */ (["person", "position", "state", "origin", "height", "radius"]);

/**
 * Equal in everything that is saved.
 * @param {Perhaps} one @param {Perhaps} other
 */
export function same(one, other) {
  if (one === other) return true;
  if (!one || !other) return false;
  return SAVED.every((key) => one[key] === other[key]);
}

/** @param {People} one @param {People} other */
export function samePeople(one, other) {
  if (one.size !== other.size) return false;
  for (const [person, annotation] of one) if (!same(annotation, other.get(person))) return false;
  return true;
}

/** @param {People} people @param {number} person @param {Perhaps} annotation */
function put(people, person, annotation) {
  if (annotation) people.set(person, annotation);
}
