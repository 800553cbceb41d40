/**
 * What is done at the sheet, as steps that can be undone. Pure but for the numbers that are given away.
 * @typedef {import("../../base/answers.js").Proposed} Proposed
 * @typedef {import("../../truth/annotation.js").State} State
 * @typedef {import("../../truth/commands.js").Patch} Patch
 * @typedef {import("../../truth/store.js").PersonEdit} PersonEdit
 * @typedef {import("../../truth/store.js").Store} Store
 * @typedef {import("./slots.js").Shown} Shown
 * @typedef {{edits: (chosen: Proposed[], state: State) => PersonEdit[]}} Proposing what makes people of proposals
 */
import { gettext, ngettext } from "../../base/messages.js";
import { annotation, changed, VALIDATED } from "../../truth/annotation.js";
import { move, patch, remove } from "../../truth/commands.js";

/** @param {Shown} shown */
export function isOpen({ state }) {
  return state === "open" || state === "doubtful";
}

/**
 * Everybody of them stands right: one step.
 * @param {Store} store @param {Proposing|null} proposing @param {Shown[]} all open ones
 */
export function acceptAll(store, proposing, all) {
  const proposed = all.flatMap(({ slot, placed }) => (slot.proposal === placed ? [slot.proposal] : []));
  const people = all.flatMap(({ slot, placed, person }) => {
    const one = slot.proposal === placed || person === null ? undefined : store.person(person);
    return one ? [{ frame: store.current, person: one.person, after: changed(one, { state: VALIDATED }) }] : [];
  });
  const label = ngettext("accept {n} person", "accept {n} people", all.length);
  return patch(store, label, [...(proposing?.edits(proposed, VALIDATED) ?? []), ...people]);
}

/**
 * Somebody stands there, whatever was thought of them before.
 * @param {Store} store @param {Proposing|null} proposing @param {Shown} shown @param {number} position that nobody has
 * @returns {Patch}
 */
export function putAt(store, proposing, { slot, placed, person }, position) {
  if (proposing && slot.proposal === placed) {
    const [edit] = proposing.edits([slot.proposal], VALIDATED);
    const after = edit.after && changed(edit.after, { position, origin: "clicked" });
    const label = gettext("place person {person}", { person: edit.person });
    return patch(store, label, [{ ...edit, after }], { select: edit.person });
  }
  if (person !== null && store.person(person)) return { ...move(store, person, position), group: null };
  const number = person ?? store.takePerson();
  const { height, radius } = placed;
  const after = annotation({ person: number, position, height, radius });
  const label = gettext("place person {person}", { person: number });
  return patch(store, label, [{ frame: store.current, person: number, after }], { select: number });
}

/**
 * Nobody is there: neither the proposal nor whoever was carried over to it.
 * @param {Store} store @param {Shown} shown @returns {Patch}
 */
export function refuse(store, { slot, placed, person }) {
  const here = person !== null && store.person(person) ? person : null;
  if (slot.proposal !== placed) {
    if (here === null) throw new TypeError("there is nobody to be refused");
    return remove(store, here);
  }
  const gone = here === null ? [] : [{ frame: store.current, person: here, after: null }];
  const refuses = { frame: store.current, position: placed.position };
  return { ...patch(store, gettext("refuse a proposal"), gone), refuses };
}
