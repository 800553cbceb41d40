/**
 * Keyframes: where a person is validated. Between two of them the person is filled in on the straight line, in
 * metres, and stays marked until looked at. Nothing here changes the store; edits are {frame, person, after}.
 */
import { annotation, CARRIED, VALIDATED } from "./annotation.js";
import { same } from "./merge.js";
import { freePosition, predictPeople } from "./propagation.js";

const INTERPOLATED = "interpolated";

/** @returns {number[]} frames in which the person is validated */
export function keyframes(store, person) {
  return store.numbers.filter((number) => store.person(person, number)?.state === VALIDATED);
}

/** Fill every gap between keyframes: where the person is missing, or carried over and not looked at. */
export function fillEdits(store, scene, person) {
  const keys = keyframes(store, person);
  const at = (number) => store.person(person, number);
  return keys.slice(1).flatMap((to, index) => gapEdits(store, scene, keys[index], to, at, () => true));
}

/** Where somebody stands in a frame between two keyframes; null when it is not between two. */
export function between(store, scene, person, number) {
  const at = (one) => store.person(person, one);
  const [gap] = gapsBeside(store, number, at);
  if (!gap || isKey(at(number))) return null;
  return gapEdits(store, scene, ...gap, at, (one) => one === number)[0]?.after ?? null;
}

/** Filled in, and not looked at since. */
export function isFilled(one) {
  return one?.state === CARRIED && one.origin === INTERPOLATED;
}

/** Follow the movement into the frames before the first and after the last one, as carry-over does. */
export function extendEdits(store, scene, person) {
  const known = store.numbers.filter((number) => store.person(person, number));
  if (!known.length) return [];
  const [first, last] = [store.numbers.indexOf(known[0]), store.numbers.indexOf(known.at(-1))];
  const source = (number) => ({ time: scene.seconds(number), people: onlyOne(store, person, number) });
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

/** A patch together with what it changes beside its keyframes. */
export function withRefill(store, scene, patch) {
  const edits = refillEdits(store, scene, patch);
  const before = (edit) => store.person(edit.person, edit.frame) ?? null;
  return edits.length
    ? { ...patch, edits: [...patch.edits, ...edits.map((edit) => ({ ...edit, before: before(edit) }))] }
    : patch;
}

/**
 * What else changes when a patch moves, makes or takes away keyframes: the frames filled in beside them, as long
 * as nobody has looked at them.
 */
function refillEdits(store, scene, patch) {
  const edited = new Map(
    patch.edits.filter((edit) => !edit.flags).map((edit) => [`${edit.frame} ${edit.person}`, edit]),
  );
  const edits = new Map();
  for (const { frame, person, before, after } of edited.values()) {
    if (!isKey(before) && !isKey(after)) continue;
    const at = (number) => {
      const edit = edited.get(`${number} ${person}`);
      return edit ? (edit.after ?? undefined) : store.person(person, number);
    };
    const refillable = (number, one) => isFilled(one) && !edited.has(`${number} ${person}`);
    for (const [from, to] of gapsBeside(store, frame, at)) {
      for (const edit of gapEdits(store, scene, from, to, at, refillable)) edits.set(`${edit.frame} ${person}`, edit);
    }
  }
  return [...edits.values()];
}

/** Pairs of keyframes with the frame between them, or with the frame as one of them. */
function gapsBeside(store, frame, at) {
  const index = store.numbers.indexOf(frame);
  const before = store.numbers.slice(0, index).findLast((number) => isKey(at(number)));
  const after = store.numbers.slice(index + 1).find((number) => isKey(at(number)));
  const gaps = isKey(at(frame))
    ? [
        [before, frame],
        [frame, after],
      ]
    : [[before, after]];
  return gaps.filter(([from, to]) => from !== undefined && to !== undefined);
}

/** The straight walk from one keyframe to the next, in those frames that may be filled and change by it. */
function gapEdits(store, scene, from, to, at, may) {
  const [start, end] = [at(from), at(to)];
  const [one, other] = [scene.metres(start.position), scene.metres(end.position)];
  const between = store.numbers.slice(store.numbers.indexOf(from) + 1, store.numbers.indexOf(to));
  return between.flatMap((number) => {
    const now = at(number);
    if (!store.frame(number).loaded || isKey(now) || !may(number, now)) return [];
    const share = (number - from) / (to - from);
    const ground = { x: one.x + share * (other.x - one.x), y: one.y + share * (other.y - one.y) };
    const taken = takenIn(store, number, start.person);
    const after = placed(scene, annotation({ ...start, origin: INTERPOLATED }), ground, taken);
    return same(now ?? null, after) ? [] : [{ frame: number, person: start.person, after }];
  });
}

function placed(scene, one, ground, taken) {
  return annotation({ ...one, position: freePosition(scene.grid, ground, taken), state: CARRIED });
}

function takenIn(store, number, except) {
  const others = [...store.people(number).values()].filter(({ person }) => person !== except);
  return new Set(others.map(({ position }) => position));
}

function onlyOne(store, person, number) {
  return new Map([[person, store.person(person, number)]]);
}

function isKey(one) {
  return one?.state === VALIDATED;
}
