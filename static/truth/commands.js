/**
 * Edits as values. A command looks at the store and answers with a patch; nothing changes before the history
 * applies it, and its inverse is the same patch read backwards. A patch may reach over several frames.
 * @typedef {import("./annotation.js").Annotation} Annotation
 * @typedef {import("./annotation.js").People} People
 * @typedef {import("./store.js").Store} Store
 * @typedef {import("./store.js").Edit} Edit
 * @typedef {import("./store.js").PersonEdit} PersonEdit
 * @typedef {import("./store.js").FlagEdit} FlagEdit
 * @typedef {import("./store.js").Flags} Flags
 * @typedef {{label: string, frame: number, edits: Edit[],
 *            selection: {before: number|null, after: number|null}, group: string|null, at: number,
 *            refuses?: {frame: number, position: number}}} Patch `refuses`: a proposal of nobody
 */

import { gettext, ngettext } from "../base/messages.js";
import { annotation, CARRIED, changed, VALIDATED } from "./annotation.js";
import { same } from "./merge.js";

/**
 * A new person, selected.
 * @param {Store} store @param {{position: number, height?: number|null, radius?: number|null}} values
 */
export function place(store, { position, height = null, radius = null }) {
  const person = store.takePerson();
  const after = annotation({ person, position, height, radius });
  return patch(store, gettext("place person {person}", { person }), [put(store.current, after)], { select: person });
}

/**
 * Moving is looking: the person is validated by it.
 * @param {Store} store @param {number} person @param {number} position
 */
export function move(store, person, position) {
  const before = store.marked(person);
  const origin = before.origin === "proposed" ? "clicked" : before.origin; // from now on it is the annotator's
  const after = changed(before, { position, state: VALIDATED, origin });
  return patch(store, gettext("move person {person}", { person }), [put(store.current, after)], {
    select: person,
    group: `move ${store.current} ${person}`,
  });
}

/** @param {Store} store @param {number[]} persons */
export function validate(store, persons) {
  const edits = persons.map((person) => put(store.current, changed(store.marked(person), { state: VALIDATED })));
  const label =
    persons.length === 1
      ? gettext("validate person {person}", { person: persons[0] })
      : ngettext("validate {n} person", "validate {n} people", persons.length);
  return patch(store, label, edits);
}

/** @param {Store} store @param {number} person */
export function remove(store, person) {
  const edit = { frame: store.current, person, after: null };
  return patch(store, gettext("remove person {person}", { person }), [edit], { select: null });
}

/**
 * People from elsewhere come into frame `number`.
 * @param {Store} store @param {number} number @param {Annotation[]} annotations
 */
export function bring(store, number, annotations) {
  const label = ngettext("carry over {n} person", "carry over {n} people", annotations.length);
  return patch(
    store,
    label,
    annotations.map((one) => put(number, one)),
    { frame: number },
  );
}

/**
 * One person as in another frame, to be looked at; takes the place of what was known here.
 * @param {Store} store @param {Annotation} after
 */
export function copy(store, after) {
  const label = gettext("copy person {person}", { person: after.person });
  return patch(store, label, [put(store.current, after)], { select: after.person });
}

/**
 * Edits of several frames at once, as one step. `edits` are {frame, person, after}.
 * @param {Store} store @param {PersonEdit[]} edits
 */
export function fill(store, edits) {
  const frames = new Set(edits.map(({ frame }) => frame)).size;
  return patch(store, ngettext("fill {n} frame", "fill {n} frames", frames), edits);
}

/**
 * A frame as it was once, with everything that was said about it.
 * @param {Store} store @param {number} number @param {{people: People} & Flags} then @param {string} label
 * @returns {Patch}
 */
export function restore(store, number, { people, done, nobody }, label) {
  const present = store.people(number);
  const changes = [...new Set([...present.keys(), ...people.keys()])]
    .filter((person) => !same(present.get(person), people.get(person)))
    .map((person) => ({ frame: number, person, after: people.get(person) ?? null }));
  const restored = patch(store, label, changes, { frame: number });
  /** @type {Edit[]} */
  const edits = restored.edits.filter((edit) => !edit.flags);
  const frame = store.frame(number);
  if (frame.done !== done || frame.nobody !== nobody) edits.push(flagEdit(store, number, { done, nobody }));
  return { ...restored, edits };
}

/**
 * The annotator leaves a frame as done; `nobody`: and says that nobody is there.
 * @param {Store} store @param {number} number @param {boolean} nobody @returns {Patch}
 */
export function finishFrame(store, number, nobody) {
  const place = store.numbers.indexOf(number) + 1;
  const finished = patch(store, gettext("finish frame {place}", { place }), [], { frame: number });
  return { ...finished, edits: [flagEdit(store, number, { done: true, nobody })] };
}

/**
 * What the annotator says about a whole frame.
 * @param {Store} store @param {number} number @param {Flags} flags @returns {FlagEdit}
 */
function flagEdit(store, number, { done, nobody }) {
  const frame = store.frame(number);
  const before = { done: frame.done, nobody: frame.nobody };
  return { frame: number, flags: { before, after: { done, nobody } } };
}

/**
 * The same patch backwards.
 * @param {Patch} original @returns {Patch}
 */
export function inverse(original) {
  /** @type {Edit[]} */
  const edits = original.edits.map((edit) =>
    edit.flags
      ? { frame: edit.frame, flags: { before: edit.flags.after, after: edit.flags.before } }
      : { frame: edit.frame, person: edit.person, before: edit.after, after: edit.before ?? null },
  );
  const { before, after } = original.selection;
  return { ...original, edits: edits.reverse(), selection: { before: after, after: before } };
}

/**
 * Two patches of one group as one: first `before`, last `after`.
 * @param {Patch} first @param {Patch} second @returns {Patch}
 */
export function combined(first, second) {
  /** @type {Edit[]} */
  const edits = first.edits.map((edit) => ({ ...edit }));
  for (const edit of second.edits) {
    const known = edits.find(
      (one) => !one.flags && !edit.flags && one.frame === edit.frame && one.person === edit.person,
    );
    if (known) known.after = edit.after;
    else edits.push(edit);
  }
  return { ...second, edits, selection: { before: first.selection.before, after: second.selection.after } };
}

/**
 * Complete edits with what was there before, and drop flags that the edits make untrue.
 * @param {Store} store @param {string} label @param {PersonEdit[]} changes
 * @param {{select?: number|null, group?: string|null, frame?: number}} [options]
 * @returns {Patch}
 */
export function patch(store, label, changes, { select, group = null, frame = store.current } = {}) {
  const edits = changes.map((edit) => ({ ...edit, before: store.person(edit.person, edit.frame) ?? null }));
  return {
    label,
    frame,
    edits: [...edits, ...flagsMadeUntrue(store, edits)],
    selection: { before: store.selection, after: select === undefined ? store.selection : select },
    group,
    at: Date.now(),
  };
}

/** @param {number} frame @param {Annotation} after @returns {PersonEdit} */
function put(frame, after) {
  return { frame, person: after.person, after };
}

/** @param {Store} store @param {PersonEdit[]} edits */
function flagsMadeUntrue(store, edits) {
  const numbers = [...new Set(edits.map((edit) => edit.frame))];
  return numbers.flatMap((number) => {
    const { done, nobody, people } = store.frame(number);
    if (!done && !nobody) return [];
    const after = new Map(people);
    for (const edit of edits) {
      if (edit.frame !== number) continue;
      if (edit.after) after.set(edit.person, edit.after);
      else after.delete(edit.person);
    }
    const stillNobody = nobody && after.size === 0;
    const anyCarried = [...after.values()].some((one) => one.state === CARRIED);
    const stillDone = done && !anyCarried && (after.size > 0 || stillNobody);
    if (stillDone === done && stillNobody === nobody) return [];
    return [flagEdit(store, number, { done: stillDone, nobody: stillNobody })];
  });
}
