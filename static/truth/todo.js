/**
 * What is left to do, and where. Pure: reads the store, changes nothing.
 * @typedef {import("./store.js").Store} Store
 * @typedef {"yellow"|"empty"|"open"|null} Left
 * @typedef {{kind: "person"|"frame"|"single", number: number, person: number|null, left: Left}} Task
 */
import { carriedOf } from "./annotation.js";

/**
 * Why a frame is not finished: "yellow", "empty", "open" (nobody said it is done), or null.
 * @param {Store} store @param {number} number @param {boolean} judging @returns {Left}
 */
function leftIn(store, number, judging) {
  const { people, done, nobody, loaded } = store.frame(number);
  if (!loaded) return null;
  if (carriedOf(people).length) return "yellow";
  if (!people.size && !nobody) return "empty";
  return judging && !done ? "open" : null;
}

/**
 * The next thing: a yellow person further down in this frame, then the next frame with something left, around
 * to the first ones, then somebody who is in one frame only.
 * @param {Store} store @param {boolean} judging
 * @param {Set<number>} asked people in one frame only who were shown already: that can be right
 * @returns {Task|null}
 */
export function nextTask(store, judging, asked = new Set()) {
  const here = carriedOf(store.people()).find(({ person }) => person > (store.selection ?? -1));
  if (here) return { kind: "person", number: store.current, person: here.person, left: "yellow" };
  const index = store.numbers.indexOf(store.current);
  const around = [...store.numbers.slice(index + 1), ...store.numbers.slice(0, index + 1)];
  for (const number of around) {
    const left = leftIn(store, number, judging);
    const [first] = carriedOf(store.people(number));
    if (left === "yellow") return { kind: "person", number, person: first.person, left };
    if (left && number !== store.current) return { kind: "frame", number, person: null, left };
  }
  const single = singles(store).find(({ person }) => !asked.has(person));
  if (single) return { kind: "single", ...single, left: null };
  const left = leftIn(store, store.current, judging);
  return left ? { kind: "frame", number: store.current, person: null, left } : null;
}

/**
 * People in exactly one frame although somebody is marked in the frames beside it.
 * @param {Store} store @returns {{person: number, number: number}[]}
 */
function singles(store) {
  /** @type {Map<number, number[]>} */
  const seen = new Map();
  for (const number of store.numbers) {
    for (const person of store.people(number).keys()) seen.set(person, [...(seen.get(person) ?? []), number]);
  }
  /** @param {number|undefined} number */
  const worked = (number) => number === undefined || store.people(number).size > 0;
  return [...seen]
    .filter(([, numbers]) => numbers.length === 1 && store.numbers.length > 1)
    .map(([person, [number]]) => ({ person, number }))
    .filter(({ number }) => worked(store.neighbour(1, number)) && worked(store.neighbour(-1, number)));
}
