/**
 * Frames as the store has them (annotations as a map), as the server sends them, and as the journal keeps them.
 * Everything a saver knows of a frame with edits is written here and read here, so that nothing is forgotten.
 */
import { annotation, asList, byPerson } from "../truth/annotation.js";
import { samePeople } from "../truth/merge.js";

/**
 * @typedef {{people: Map<number, import("../truth/annotation.js").Annotation>, done: boolean, nobody: boolean}} State
 * @typedef {State & {revision: number}} Base what the server has for certain
 * @typedef {import("../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../truth/annotation.js").AnnotationValues} AnnotationValues
 * @typedef {import("../base/answers.js").SaveBody} SaveBody
 * @typedef {{saveId: string, body: SaveBody, edits: number}} Sending `edits`: how many of the slot's it brings
 * @typedef {{frame: number, conflicts: import("../truth/merge.js").Conflict[], author: string,
 *            savedAt: string|null}} Question what the annotator has to decide
 * @typedef {{annotations: AnnotationValues[], done?: boolean, nobody?: boolean}} Plain
 *
 * @typedef {object} Slot what a saver knows of a frame
 * @property {Base} base
 * @property {Sending|null} sending
 * @property {Promise<void>|null} busy while it is under way
 * @property {number} edits not acknowledged
 * @property {Set<number>} added people of ours that the server got from us
 * @property {Question|null} question
 * @property {string|null} refused why
 *
 * @typedef {object} StoredRecord as the journal keeps it; earlier versions forgot some of it
 * @property {Plain & {revision?: number}} base
 * @property {Plain} ours
 * @property {{saveId: string, body: Omit<SaveBody, "revision"> & {revision?: number}, edits?: number}|null} sending
 * @property {Question|null} [question]
 * @property {number} edits
 * @property {number[]} [added]
 * @property {number} [seconds]
 * @property {number} at when it was written, ms
 *
 * @typedef {{base: State & {revision: number|undefined}, ours: State, sending: Sending|null, question: Question|null,
 *            edits: number, added: Set<number>, seconds: number}} Kept a record read back
 */

/** From JSON. @param {Plain} state @returns {State} */
export function stateOf({ annotations, done, nobody }) {
  return { people: byPerson(annotations), done: Boolean(done), nobody: Boolean(nobody) };
}

/** @param {Plain & {revision: number}} state @returns {Base} */
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

/**
 * A slot of the saver as the journal keeps it.
 * @param {Slot} slot @param {State} ours @param {number} seconds not sent yet
 * @returns {StoredRecord}
 */
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
 * @param {StoredRecord} record @returns {Kept}
 */
export function readRecord({ base, ours, sending, question, edits, added = [], seconds = 0 }) {
  const complete = sending && isComplete(sending) ? sending : null;
  return {
    base: { revision: base.revision ?? complete?.body.revision, ...stateOf(base) },
    ours: stateOf(ours),
    sending: complete && { edits, ...complete },
    question: revived(question),
    edits,
    added: new Set(added),
    seconds: seconds + (sending && !complete ? (sending.body.seconds ?? 0) : 0),
  };
}

/**
 * @param {NonNullable<StoredRecord["sending"]>} sending
 * @returns {sending is {saveId: string, body: SaveBody, edits?: number}}
 */
function isComplete(sending) {
  return Number.isInteger(sending.body.revision);
}

/**
 * The database gives plain values back.
 * @param {Question|null|undefined} question @returns {Question|null}
 */
function revived(question) {
  if (!question) return null;
  /** @param {Annotation|undefined} one */
  const frozen = (one) => (one ? annotation(one) : undefined);
  const conflicts = question.conflicts.map((one) => ({ ...one, ours: frozen(one.ours), theirs: frozen(one.theirs) }));
  return { ...question, conflicts };
}
