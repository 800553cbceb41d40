/** Frames that people can be carried over from. */
const LOOK_BACK = 3; // frames on one side that movement is read from

/** Frames with people before (`direction` -1) or after (1) a frame, nearest first, at most `LOOK_BACK`. */
export function sourcesOn(store, scene, number, direction) {
  const index = store.numbers.indexOf(number);
  const side = direction < 0 ? store.numbers.slice(0, index).reverse() : store.numbers.slice(index + 1);
  return side
    .filter((one) => store.frame(one).loaded && store.people(one).size)
    .slice(0, LOOK_BACK)
    .map((one) => ({ number: one, time: scene.seconds(one), people: store.people(one) }));
}

/** The side whose people are nearer in time; the earlier one when both are as near. */
export function nearestSide(store, scene, number) {
  const [before, after] = [-1, 1].map((direction) => sourcesOn(store, scene, number, direction));
  if (!before.length || !after.length) return before.length ? before : after;
  const time = scene.seconds(number);
  return time - before[0].time <= after[0].time - time ? before : after;
}
