/**
 * Where what is annotated cannot be: two people in one place, somebody faster than people are, and somebody who
 * vanishes where there is no way out while another appears beside. Pure.
 * @typedef {{x: number, y: number}} XY metres
 * @typedef {import("./annotation.js").People} People
 * @typedef {{number: number, time: number, people: Map<number, XY>}} Placed
 * @typedef {{person: number, place: XY, index: number}} End
 * @typedef {{metres: (position: number) => XY, inMiddle: (ground: XY) => boolean}} Ground
 * @typedef {{kind: "close"|"fast"|"renumbered", key: string, frame: number, persons: number[],
 *            at: XY[], from: XY|null, value: number}} Warning
 *   `at`: where the persons stand in the frame, metres; `from`: where the second one comes from; `value`: metres
 *   apart, or m/s.
 */
export const NEAREST = 0.3; // metres; two bodies do not fit closer
export const FASTEST = 3; // m/s
const MIDDLE = 0.5; // metres from the border of the area and of what is seen
const WALKING = 2; // m/s, for somebody who was lost and is found again
const LOST = 3; // frames until somebody lost counts as gone
const FARTHEST = 3; // metres between the two ends of a path that may be one
const AROUND = 8; // directions in which the middle is looked for

/**
 * @param {{number: number, time: number, people: People}[]} frames in order, with nothing left out between two of them
 * @param {Ground} ground
 * @returns {Warning[]} in the order of frames
 */
export function findWarnings(frames, ground) {
  const placed = frames.map(({ number, time, people }) => ({
    number,
    time,
    people: new Map([...people].map(([person, { position }]) => [person, ground.metres(position)])),
  }));
  const found = [
    ...placed.flatMap(tooClose),
    ...placed.slice(1).flatMap((frame, index) => tooFast(placed[index], frame)),
    ...renumbered(placed, ground),
  ];
  return found.sort((one, other) => one.frame - other.frame);
}

/**
 * Whether a ground point is well inside: seen, and not near where people come in and go out.
 * @param {XY} point @param {(point: XY) => boolean} isSeen
 */
export function inMiddle(point, isSeen) {
  return Array.from({ length: AROUND }, (_, index) => (2 * Math.PI * index) / AROUND).every((angle) =>
    isSeen({ x: point.x + MIDDLE * Math.cos(angle), y: point.y + MIDDLE * Math.sin(angle) }),
  );
}

/** @param {Placed} frame @returns {Warning[]} */
function tooClose({ number, people }) {
  const all = [...people].sort(([one], [other]) => one - other);
  return all.flatMap(([person, here], index) =>
    all
      .slice(index + 1)
      .filter(([, there]) => distance(here, there) < NEAREST)
      .map(([other, there]) => warning("close", number, [person, other], [here, there], null, distance(here, there))),
  );
}

/** @param {Placed} before @param {Placed} frame @returns {Warning[]} */
function tooFast(before, { number, time, people }) {
  return [...people].flatMap(([person, here]) => {
    const from = before.people.get(person);
    const speed = from ? distance(from, here) / (time - before.time) : 0;
    return from && speed > FASTEST ? [warning("fast", number, [person], [here], from, speed)] : [];
  });
}

/**
 * Everybody who ends in the middle, with the nearest one who begins soon after, in the middle too.
 * @param {Placed[]} frames @param {Ground} ground @returns {Warning[]}
 */
function renumbered(frames, ground) {
  const begins = ends([...frames].reverse()).map(({ index, ...start }) => ({
    ...start,
    index: frames.length - 1 - index,
  }));
  const pairs = ends(frames).flatMap((end) =>
    begins
      .filter(({ index }) => index > end.index && index <= end.index + LOST)
      .map((start) => ({
        end,
        start,
        apart: distance(end.place, start.place),
        seconds: frames[start.index].time - frames[end.index].time,
      }))
      .filter(({ apart, seconds }) => apart <= Math.min(FARTHEST, WALKING * seconds)),
  );
  /** @type {Set<End>} */
  const taken = new Set();
  return pairs
    .filter(({ end, start }) => ground.inMiddle(end.place) && ground.inMiddle(start.place))
    .sort((one, other) => one.apart - other.apart)
    .filter(({ end, start }) => {
      if (taken.has(end) || taken.has(start)) return false;
      taken.add(end).add(start);
      return true;
    })
    .map(({ end, start, apart }) =>
      warning("renumbered", frames[start.index].number, [end.person, start.person], [start.place], end.place, apart),
    );
}

/**
 * Where each person is marked for the last time, unless that is the last frame.
 * @param {Placed[]} frames
 */
function ends(frames) {
  /** @type {Map<number, End>} */
  const last = new Map();
  frames.forEach(({ people }, index) => people.forEach((place, person) => last.set(person, { person, place, index })));
  return [...last.values()].filter(({ index }) => index < frames.length - 1);
}

/**
 * @param {Warning["kind"]} kind @param {number} frame @param {number[]} persons @param {XY[]} at
 * @param {XY|null} from @param {number} value @returns {Warning}
 */
function warning(kind, frame, persons, at, from, value) {
  return { kind, key: `${kind} ${frame} ${persons.join(" ")}`, frame, persons, at, from, value };
}

/** @param {XY} one @param {XY} other */
function distance(one, other) {
  return Math.hypot(one.x - other.x, one.y - other.y);
}
