/**
 * Frames as the store has them (annotations as a map), as the server sends them, and as the journal keeps them.
 * Everything a saver knows of a frame with edits is written here and read here, so that nothing is forgotten.
 */
import { annotation, asList, byPerson } from "../truth/annotation.js";
import { samePeople } from "../truth/merge.js";

/**
 * @typedef {{people: Map<number, import("../truth/annotation.js").Annotation>, done: boolean, nobody: boolean}} State
 * @typedef {State & {revision: number}} Base what the server has for certain
 */

/** From JSON. @returns {State} */
export function stateOf({ annotations, done, nobody }) {
  return { people: byPerson(annotations), done: Boolean(done), nobody: Boolean(nobody) };
}

/** @returns {Base} */
export function baseOf(state) {
  return { revision: state.revision, ...stateOf(state) };
}

/** To JSON. @param {State} state */
export function plain({ people, done, nobody }) {
  return { annotations: asList(people), done, nobody };
}

/** @param {State} one @param {State} other */
export function isSame(one, other) {
  return samePeople(one.people, other.people) && one.done === other.done && one.nobody === other.nobody;
}

/** A slot of the saver as the journal keeps it. @param {State} ours @param {number} seconds not sent yet */
export function recordOf(slot, ours, seconds) {
  const { base, sending, question, edits, added } = slot;
  return {
    base: { revision: base.revision, ...plain(base) },
    ours: plain(ours),
    sending: sending && { saveId: sending.saveId, body: sending.body, edits: sending.edits },
    question, // a crash must not answer it
    edits,
    added: [...added],
    seconds,
    at: Date.now(),
  };
}

/**
 * The record back again. Earlier versions forgot the base's revision (then `base.revision` is undefined), and
 * with it made saves the server can only refuse.
 */
export function readRecord({ base, ours, sending, question, edits, added = [], seconds = 0 }) {
  const complete = sending && Number.isInteger(sending.body.revision);
  return {
    base: { revision: base.revision ?? (complete ? sending.body.revision : undefined), ...stateOf(base) },
    ours: stateOf(ours),
    sending: complete ? { edits, ...sending } : null,
    question: revived(question),
    edits,
    added: new Set(added),
    seconds: seconds + (sending && !complete ? (sending.body.seconds ?? 0) : 0),
  };
}

/** The database gives plain values back. */
function revived(question) {
  if (!question) return null;
  const frozen = (one) => (one ? annotation(one) : undefined);
  const conflicts = question.conflicts.map((one) => ({ ...one, ours: frozen(one.ours), theirs: frozen(one.theirs) }));
  return { ...question, conflicts };
}
