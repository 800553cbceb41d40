/**
 * Everybody of a frame side by side: one slot each, which keeps its place whatever becomes of whom it shows. Pure.
 * @typedef {import("../../base/answers.js").Proposed} Proposed
 * @typedef {import("../../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../../truth/annotation.js").People} People
 * @typedef {import("../../views/pane.js").Placed} Placed
 * @typedef {"open"|"doubtful"|"accepted"|"refused"} SlotState `open`: whoever is accepted with all the rest
 * @typedef {{proposal: Proposed|null, person: number|null, shown: Placed}} Slot `shown`: as it was seen last
 * @typedef {{slot: Slot, state: SlotState, person: number|null, placed: Placed}} Shown what a tile shows
 * @typedef {object} Frame
 * @property {People} people
 * @property {Proposed[]} open proposals nobody has looked at
 * @property {(one: Proposed) => number|null} personOf whom a proposal is of, or would be
 * @property {(one: Proposed) => boolean} doubtful
 */
import { CARRIED } from "../../truth/annotation.js";

const GUESSED = 0.5; // doubt about somebody carried over whom nobody proposes here

/**
 * The slots of a frame as it is opened: the most doubtful first, whoever is accepted already at the end.
 * @param {Frame} frame @returns {Slot[]}
 */
export function slotsOf(frame) {
  const slots = [...proposalSlots(frame, []), ...peopleSlots(frame, [])];
  const doubts = new Map(slots.map((slot) => [slot, doubtOf(frame, slot)]));
  return slots.sort((one, other) => (doubts.get(other) ?? 0) - (doubts.get(one) ?? 0));
}

/**
 * Whoever has come since has a slot after the others.
 * @param {Slot[]} slots @param {Frame} frame @returns {Slot[]}
 */
export function extended(slots, frame) {
  const added = [...slots, ...proposalSlots(frame, slots)];
  return [...added, ...peopleSlots(frame, added)];
}

/**
 * What a slot shows now, and notes where that is.
 * @param {Slot} slot @param {Frame} frame @returns {Shown}
 */
export function shownOf(slot, frame) {
  const open = slot.proposal && frame.open.find(({ id }) => id === slot.proposal?.id);
  if (open) {
    Object.assign(slot, { shown: open, proposal: open });
    return { slot, state: frame.doubtful(open) ? "doubtful" : "open", person: frame.personOf(open), placed: open };
  }
  const person = slot.proposal ? (frame.personOf(slot.proposal) ?? slot.person) : slot.person;
  const one = person === null ? undefined : frame.people.get(person);
  if (!one) return { slot, state: "refused", person, placed: slot.shown };
  Object.assign(slot, { shown: one, person });
  return { slot, state: one.state === CARRIED ? "open" : "accepted", person, placed: one };
}

/** @param {Frame} frame @param {Slot[]} known @returns {Slot[]} */
function proposalSlots(frame, known) {
  const ids = new Set(known.map(({ proposal }) => proposal?.id));
  return frame.open
    .filter(({ id }) => !ids.has(id))
    .map((one) => ({ proposal: one, person: frame.personOf(one), shown: one }));
}

/**
 * People whom no slot shows yet.
 * @param {Frame} frame @param {Slot[]} known @returns {Slot[]}
 */
function peopleSlots(frame, known) {
  const proposed = frame.open.map((one) => frame.personOf(one));
  const shown = known.map((slot) => (slot.proposal ? (frame.personOf(slot.proposal) ?? slot.person) : slot.person));
  const taken = new Set([...proposed, ...shown]);
  return [...frame.people.values()]
    .filter(({ person }) => !taken.has(person))
    .sort((one, other) => one.person - other.person)
    .map((one) => ({ proposal: null, person: one.person, shown: one }));
}

/** @param {Frame} frame @param {Slot} slot */
function doubtOf({ people }, { proposal, person }) {
  if (proposal) return proposal.doubt;
  const one = person === null ? undefined : people.get(person);
  return one?.state === CARRIED ? GUESSED : -1;
}
