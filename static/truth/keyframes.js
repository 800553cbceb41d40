/**
 * Keyframes: where a person is validated. Between two of them the person is filled in on the straight line, in
 * metres, and stays marked until looked at. Nothing here changes the store; edits are {frame, person, after}.
 * @typedef {import("./annotation.js").Annotation} Annotation
 * @typedef {import("./commands.js").Patch} Patch
 * @typedef {import("./scene.js").Scene} Scene
 * @typedef {import("./store.js").PersonEdit} PersonEdit
 * @typedef {import("./store.js").Store} Store
 * @typedef {(number: number) => Annotation|undefined} At one person by frame, as it is or would be
 * @typedef {(number: number, one: Annotation|undefined) => boolean} May whether a frame may be filled
 */
import { CARRIED, changed, VALIDATED } from "./annotation.js";
import { same } from "./merge.js";
import { freePosition, predictPeople } from "./propagation.js";

const INTERPOLATED = "interpolated";

/** @param {Store} store @param {number} person @returns {number[]} frames in which the person is validated */
export function keyframes(store, person) {
  return store.numbers.filter((number) => store.person(person, number)?.state === VALIDATED);
}

/**
 * Fill every gap between keyframes: where the person is missing, or carried over and not looked at.
 * @param {Store} store @param {Scene} scene @param {number} person
 */
export function fillEdits(store, scene, person) {
  const keys = keyframes(store, person);
  /** @type {At} */
  const at = (number) => store.person(person, number);
  return keys.slice(1).flatMap((to, index) => gapEdits(store, scene, keys[index], to, at, () => true));
}

/**
 * Where somebody stands in a frame between two keyframes; null when it is not between two.
 * @param {Store} store @param {Scene} scene @param {number} person @param {number} number
 */
export function between(store, scene, person, number) {
  /** @type {At} */
  const at = (one) => store.person(person, one);
  const [gap] = gapsBeside(store, number, at);
  if (!gap || isKey(at(number))) return null;
  return gapEdits(store, scene, ...gap, at, (one) => one === number)[0]?.after ?? null;
}

/**
 * Filled in, and not looked at since.
 * @param {Annotation|undefined} one @returns {one is Annotation}
 */
export function isFilled(one) {
  return one?.state === CARRIED && one.origin === INTERPOLATED;
}

/**
 * Follow the movement into the frames before the first and after the last one, as carry-over does.
 * @param {Store} store @param {Scene} scene @param {number} person @returns {PersonEdit[]}
 */
export function extendEdits(store, scene, person) {
  const known = store.numbers.filter((number) => store.person(person, number));
  if (!known.length) return [];
  const [first, last] = [known[0], known[known.length - 1]].map((number) => store.numbers.indexOf(number));
  /** @param {number} number */
  const source = (number) => ({ time: scene.seconds(number), people: onlyOne(store, person, number) });
  /** @type {(numbers: number[], sources: import("./propagation.js").Moment[]) => PersonEdit[]} */
  const follow = (numbers, sources) =>
    numbers
      .filter((number) => store.frame(number).loaded)
      .map((number) => {
        const [after] = predictPeople(scene.grid, scene.seconds(number), sources);
        const taken = takenIn(store, number, person);
        return { frame: number, person, after: placed(scene, after, scene.metres(after.position), taken) };
      });
  return [
    ...follow(store.numbers.slice(0, first), known.map(source)),
    ...follow(store.numbers.slice(last + 1), known.map(source).reverse()),
  ];
}

/**
 * A patch together with what it changes beside its keyframes.
 * @param {Store} store @param {Scene} scene @param {Patch} patch @returns {Patch}
 */
export function withRefill(store, scene, patch) {
  const edits = refillEdits(store, scene, patch);
  /** @param {PersonEdit} edit */
  const before = (edit) => store.person(edit.person, edit.frame) ?? null;
  return edits.length
    ? { ...patch, edits: [...patch.edits, ...edits.map((edit) => ({ ...edit, before: before(edit) }))] }
    : patch;
}

/**
 * What else changes when a patch moves, makes or takes away keyframes: the frames filled in beside them, as long
 * as nobody has looked at them.
 * @param {Store} store @param {Scene} scene @param {Patch} patch
 */
function refillEdits(store, scene, patch) {
  const edited = new Map(
    patch.edits.filter((edit) => !edit.flags).map((edit) => [`${edit.frame} ${edit.person}`, edit]),
  );
  /** @type {Map<string, PersonEdit>} */
  const edits = new Map();
  for (const { frame, person, before, after } of edited.values()) {
    if (!isKey(before) && !isKey(after)) continue;
    /** @type {At} */
    const at = (number) => {
      const edit = edited.get(`${number} ${person}`);
      return edit ? (edit.after ?? undefined) : store.person(person, number);
    };
    /** @type {May} */
    const refillable = (number, one) => isFilled(one) && !edited.has(`${number} ${person}`);
    for (const [from, to] of gapsBeside(store, frame, at)) {
      for (const edit of gapEdits(store, scene, from, to, at, refillable)) edits.set(`${edit.frame} ${person}`, edit);
    }
  }
  return [...edits.values()];
}

/**
 * Pairs of keyframes with the frame between them, or with the frame as one of them.
 * @param {Store} store @param {number} frame @param {At} at @returns {[number, number][]}
 */
function gapsBeside(store, frame, at) {
  const index = store.numbers.indexOf(frame);
  const before = store.numbers.slice(0, index).findLast((number) => isKey(at(number)));
  const after = store.numbers.slice(index + 1).find((number) => isKey(at(number)));
  const ends = isKey(at(frame)) ? [before, frame, after] : [before, after];
  /** @type {[number, number][]} */
  const gaps = [];
  ends.slice(1).forEach((to, index) => {
    const from = ends[index];
    if (from !== undefined && to !== undefined) gaps.push([from, to]);
  });
  return gaps;
}

/**
 * The straight walk from one keyframe to the next, in those frames that may be filled and change by it.
 * @param {Store} store @param {Scene} scene @param {number} from @param {number} to @param {At} at @param {May} may
 * @returns {PersonEdit[]}
 */
function gapEdits(store, scene, from, to, at, may) {
  const [start, end] = [at(from), at(to)];
  if (!start || !end) return [];
  const [one, other] = [scene.metres(start.position), scene.metres(end.position)];
  const between = store.numbers.slice(store.numbers.indexOf(from) + 1, store.numbers.indexOf(to));
  return between.flatMap((number) => {
    const now = at(number);
    if (!store.frame(number).loaded || isKey(now) || !may(number, now)) return [];
    const share = (number - from) / (to - from);
    const ground = { x: one.x + share * (other.x - one.x), y: one.y + share * (other.y - one.y) };
    const taken = takenIn(store, number, start.person);
    const after = placed(scene, changed(start, { origin: INTERPOLATED }), ground, taken);
    return same(now ?? null, after) ? [] : [{ frame: number, person: start.person, after }];
  });
}

/**
 * @param {Scene} scene @param {Annotation} one @param {{x: number, y: number}} ground @param {Set<number>} taken
 */
function placed(scene, one, ground, taken) {
  return changed(one, { position: freePosition(scene.grid, ground, taken), state: CARRIED });
}

/** @param {Store} store @param {number} number @param {number} except */
function takenIn(store, number, except) {
  const others = [...store.people(number).values()].filter(({ person }) => person !== except);
  return new Set(others.map(({ position }) => position));
}

/**
 * @param {Store} store @param {number} person @param {number} number
 * @returns {import("./annotation.js").People}
 */
function onlyOne(store, person, number) {
  return new Map([[person, store.marked(person, number)]]);
}

/** @param {Annotation|null|undefined} one */
function isKey(one) {
  return one?.state === VALIDATED;
}
