/**
 * One person at one position. Frozen and replaced, never changed: what hangs on it (rectangles, undo, what was
 * sent) can hold on to it safely.
 * @typedef {{person: number, position: number, state: "validated"|"carried", origin: string,
 *            height: number|null, radius: number|null}} Annotation
 */
export const VALIDATED = "validated";
export const CARRIED = "carried";

/** @returns {Readonly<Annotation>} */
export function annotation({ person, position, state = VALIDATED, origin = "clicked", height = null, radius = null }) {
  return Object.freeze({ person, position, state, origin, height, radius });
}

/** A copy with some values changed. */
export function changed(original, values) {
  return annotation({ ...original, ...values });
}

export function byPerson(annotations) {
  return new Map(annotations.map((one) => [one.person, annotation(one)]));
}

/** Sorted by person: the same people always give the same bytes. */
export function asList(people) {
  return [...people.values()].sort((one, other) => one.person - other.person);
}

export function carriedOf(people) {
  return asList(people).filter((one) => one.state === CARRIED);
}
