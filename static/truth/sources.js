/**
 * Frames that people can be carried over from: of the batch, and accepted ones beside it.
 * @typedef {import("./annotation.js").Annotation} Annotation
 * @typedef {import("./annotation.js").People} People
 * @typedef {import("./scene.js").Scene} Scene
 * @typedef {import("./store.js").Store} Store
 * @typedef {{number: number, people: People, outside: boolean}} Beside `outside`: of the neighbouring batch
 * @typedef {Beside & {time: number}} FrameSource seconds
 */
import { VALIDATED } from "./annotation.js";

const LOOK_BACK = 4; // frames on one side that movement is read from

/**
 * Frames with people before (`direction` -1) or after (1) a frame, nearest first.
 * @param {Store} store @param {Scene} scene @param {number} number @param {number} direction
 * @param {(source: Beside) => boolean} counts
 * @returns {FrameSource[]}
 */
export function sourcesOn(store, scene, number, direction, counts = () => true) {
  const index = store.numbers.indexOf(number);
  const side = direction < 0 ? store.numbers.slice(0, index).reverse() : store.numbers.slice(index + 1);
  const inside = side
    .filter((one) => store.frame(one).loaded)
    .map((one) => ({ number: one, people: store.people(one), outside: false }));
  const beyond = direction < 0 ? scene.neighbours.before : scene.neighbours.after;
  return [...inside, ...beyond.map((frame) => ({ ...frame, outside: true }))]
    .filter((source) => source.people.size && counts(source))
    .slice(0, LOOK_BACK)
    .map((source) => ({ ...source, time: scene.seconds(source.number) }));
}

/**
 * The side whose people are nearer in time; the earlier one when both are as near. Frames in which nobody was
 * looked at yet are guesses themselves and don't count.
 * @param {Store} store @param {Scene} scene @param {number} number
 */
export function nearestSide(store, scene, number) {
  const [before, after] = [-1, 1].map((direction) => sourcesOn(store, scene, number, direction, wasLookedAt));
  if (!before.length || !after.length) return before.length ? before : after;
  const time = scene.seconds(number);
  return time - before[0].time <= after[0].time - time ? before : after;
}

/** @param {Beside} source */
function wasLookedAt({ people, outside }) {
  return outside || [...people.values()].some(({ state }) => state === VALIDATED);
}

/**
 * People from another layer's frame keep their numbers where this layer has never used them; the others are
 * somebody else here, and get new numbers.
 * @param {Store} store @param {Annotation[]} annotations
 */
export function withFreeNumbers(store, annotations) {
  const free = new Set(annotations.map(({ person }) => person).filter((person) => store.isUnused(person)));
  for (const person of free) store.reservePerson(person);
  return annotations.map((one) => (free.has(one.person) ? one : Object.freeze({ ...one, person: store.takePerson() })));
}
