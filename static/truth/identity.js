/**
 * Who is who, over several frames at once. Pure: looks at the store, answers with a patch that the history can
 * run, and says what stands in its way. Numbers are never given twice: a number somebody had stays theirs.
 * @typedef {{kind: "rename"|"split"|"join"|"swap"|"remove", person: number, other: number|null,
 *            scope: "here"|"onwards"|"everywhere", keep: "moved"|"present"|"both"}} Choice
 *   `other`: the new number, or the second person. `keep`: who stays where both are marked: the one that gets the
 *   number (moved), the one that has it (present), or both with their numbers swapped.
 * @typedef {import("./annotation.js").Annotation} Annotation
 * @typedef {import("./commands.js").Patch} Patch
 * @typedef {import("./store.js").PersonEdit} PersonEdit
 * @typedef {import("./store.js").Store} Store
 * @typedef {Choice & {other: number}} Complete a choice without a problem: whoever needs a second number has one
 */

import { gettext } from "../base/messages.js";
import { changed } from "./annotation.js";
import { patch } from "./commands.js";
import { same } from "./merge.js";

const NOBODY = -1; // where a choice needs no second number
export const LARGEST = 999_999; // a slip of the finger must not use up the numbers of the whole layer

/**
 * @param {Store} store @param {Choice} choice
 * @returns {{patch: Patch|null, both: number[], problem: string|null}} `both`: frames where the number is taken
 */
export function plan(store, choice) {
  const { person, kind } = choice;
  const problem = problemOf(store, choice);
  if (problem) return { patch: null, both: [], problem };
  const complete = { ...choice, other: choice.other ?? NOBODY };
  const numbers = framesIn(store, scopeOf(choice));
  const both =
    kind === "rename" || kind === "join"
      ? framesWith(store, person, numbers).filter((number) => store.person(complete.other, number))
      : [];
  const wanted = PLANS[kind](store, complete, numbers);
  if (!wanted.edits.length) return { patch: null, both, problem: gettext("That would change nothing") };
  return { patch: wanted, both, problem: null };
}

/**
 * Frames, in order, in which the person is marked.
 * @param {Store} store @param {number} person @param {number[]} [numbers]
 */
export function framesWith(store, person, numbers = store.numbers) {
  return numbers.filter((number) => store.person(person, number));
}

/**
 * Everybody marked anywhere, by number.
 * @param {Store} store
 */
export function everybody(store) {
  const persons = new Set(store.numbers.flatMap((number) => [...store.people(number).keys()]));
  return [...persons].sort((one, other) => one - other);
}

/** @type {Record<Choice["kind"], (store: Store, choice: Complete, numbers: number[]) => Patch>} */
const PLANS = {
  rename(store, { person, other, keep }, numbers) {
    /** @type {[number, number][]} */
    const names =
      keep === "both"
        ? [
            [person, other],
            [other, person],
          ]
        : [[person, other]];
    const label = gettext("rename person {person} to {other}", { person, other });
    return patch(store, label, relabelled(store, numbers, new Map(names), keep), { select: other });
  },
  split(store, { person }, numbers) {
    const other = store.nextPerson;
    const label = gettext("split person {person}: {other} from here on", { person, other });
    return patch(store, label, relabelled(store, numbers, new Map([[person, other]])), { select: other });
  },
  join(store, { person, other, keep }, numbers) {
    const label = gettext("join person {other} into person {person}", { person, other });
    return patch(store, label, relabelled(store, numbers, new Map([[other, person]]), keep), { select: person });
  },
  swap(store, { person, other }, numbers) {
    const label = gettext("swap person {person} and person {other}", { person, other });
    const names = new Map([
      [person, other],
      [other, person],
    ]);
    return patch(store, label, relabelled(store, numbers, names), { select: other }); // the same body stays selected
  },
  remove(store, { person, scope }, numbers) {
    const label = {
      here: gettext("remove person {person}", { person }),
      onwards: gettext("remove person {person} from here on", { person }),
      everywhere: gettext("remove person {person} everywhere", { person }),
    }[scope];
    const edits = framesWith(store, person, numbers).map((frame) => ({ frame, person, after: null }));
    return patch(store, label, edits, { select: null });
  },
};

/** @param {Choice} choice @returns {Choice["scope"]} */
function scopeOf({ kind, scope }) {
  if (kind === "split" || kind === "swap") return "onwards";
  return kind === "join" ? "everywhere" : scope;
}

/** @param {Store} store @param {Choice["scope"]} scope */
function framesIn(store, scope) {
  if (scope === "everywhere") return store.numbers;
  const index = store.numbers.indexOf(store.current);
  return store.numbers.slice(index, scope === "here" ? index + 1 : undefined);
}

/**
 * Everybody in `names` gets the new name; at most one edit for each person and frame.
 * @param {Store} store @param {number[]} numbers @param {Map<number, number>} names
 * @param {Choice["keep"]} [keep]
 * @returns {PersonEdit[]}
 */
function relabelled(store, numbers, names, keep = "moved") {
  return numbers.flatMap((frame) => {
    const people = store.people(frame);
    const moving = [...names].filter(([from]) => people.has(from));
    /** @type {Map<number, Annotation>} */
    const after = new Map();
    for (const [, to] of moving) if (people.has(to) && !names.has(to)) after.set(to, store.marked(to, frame));
    for (const [from, to] of moving) {
      if (!after.has(to) || keep === "moved") after.set(to, changed(store.marked(from, frame), { person: to }));
    }
    return [...new Set(moving.flat())]
      .filter((person) => !same(people.get(person), after.get(person)))
      .map((person) => ({ frame, person, after: after.get(person) ?? null }));
  });
}

/** @param {Store} store @param {Choice} choice @returns {string|null} */
function problemOf(store, { kind, person, other }) {
  if (kind === "split") {
    const [first] = framesWith(store, person);
    return first === undefined || first >= store.current
      ? gettext("Person {person} is not marked before this frame: there is nothing to split", { person })
      : null;
  }
  if (kind === "remove") return null;
  if (other === null || !Number.isInteger(other) || other < 0 || other > LARGEST) {
    return kind === "rename" ? gettext("What is the new number?") : gettext("Who is the other person?");
  }
  if (other === person) return gettext("That is the number it has");
  if (kind === "rename" && !store.isUnused(other) && !framesWith(store, other).length) {
    return gettext("Number {other} belonged to somebody, and numbers are never given twice. Free from {free} on.", {
      other,
      free: store.nextPerson,
    });
  }
  return null;
}
