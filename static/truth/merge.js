/**
 * Three-way merge of one frame, per person. Pure: maps person → annotation in, a new map out.
 * A person only one side changed is taken from that side. Both sides added the same number for different
 * positions: two different people, ours is listed in `renumber`. Everything else both changed differently is a
 * conflict, in which `people` keeps ours until the annotator decides.
 * @returns {{people: Map, conflicts: {person, base, ours, theirs}[], renumber: number[]}}
 */
export function mergePeople(base, ours, theirs) {
  const people = new Map();
  const conflicts = [];
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

/** A flag only one side changed follows that side; both changed means both set it to the same value. */
export function mergeFlag(base, ours, theirs) {
  return ours !== base ? ours : theirs;
}

/** Equal in everything that is saved. */
export function same(one, other) {
  if (one === other) return true;
  if (!one || !other) return false;
  return ["person", "position", "state", "origin", "height", "radius"].every((key) => one[key] === other[key]);
}

export function samePeople(one, other) {
  if (one.size !== other.size) return false;
  for (const [person, annotation] of one) if (!same(annotation, other.get(person))) return false;
  return true;
}

function put(people, person, annotation) {
  if (annotation) people.set(person, annotation);
}
