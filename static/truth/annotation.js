/**
 * One person at one position. Frozen and replaced, never changed: what hangs on it (rectangles, undo, what was
 * sent) can hold on to it safely.
 * @typedef {"validated"|"carried"} State
 * @typedef {Readonly<{person: number, position: number, state: State, origin: string,
 *            height: number|null, radius: number|null}>} Annotation
 * @typedef {{person: number, position: number} & Partial<Annotation>} AnnotationValues
 * @typedef {Map<number, Annotation>} People by their numbers
 * @type {State}
 */
export const VALIDATED = "validated";
/** @type {State} */
export const CARRIED = "carried";

/** @param {AnnotationValues} values @returns {Annotation} */
export function annotation({ person, position, state = VALIDATED, origin = "clicked", height = null, radius = null }) {
  return Object.freeze({ person, position, state, origin, height, radius });
}

/**
 * A copy with some values changed.
 * @param {Annotation} original @param {Partial<Annotation>} values
 */
export function changed(original, values) {
  return annotation({ ...original, ...values });
}

/** @param {AnnotationValues[]} annotations @returns {People} */
export function byPerson(annotations) {
  return new Map(annotations.map((one) => [one.person, annotation(one)]));
}

/**
 * Sorted by person: the same people always give the same bytes.
 * @param {People} people @returns {Annotation[]}
 */
export function asList(people) {
  return [...people.values()].sort((one, other) => one.person - other.person);
}

/** @param {People} people */
export function carriedOf(people) {
  return asList(people).filter((one) => one.state === CARRIED);
}
