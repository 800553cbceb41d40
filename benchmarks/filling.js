/** Fills in real people between keyframes with the workbench's own modules, and compares with where they were. */
import { annotation } from "/static/truth/annotation.js";
import { fillEdits } from "/static/truth/keyframes.js";
import { Scene } from "/static/truth/scene.js";
import { Store } from "/static/truth/store.js";

const NEAR = 0.1; // metres

/** @param {{scene: object, truth: Object<string, number>[], step: number}} job every `step`-th frame is a keyframe */
export function measure({ scene: json, truth, step }) {
  const scene = new Scene(json);
  const counts = { filled: 0, near: 0, between: 0, keyed: 0 };
  for (let first = 0; first < step; first += 1) add(counts, one(scene, truth, first, step));
  return counts;
}

function one(scene, truth, first, step) {
  const last = first + step * Math.floor((truth.length - 1 - first) / step);
  const store = new Store(
    scene.frames.map(({ number }) => number),
    1,
  );
  truth.forEach((people, index) => {
    const isKey = index >= first && index <= last && (index - first) % step === 0;
    store.install(store.numbers[index], { people: isKey ? annotated(people) : new Map() }, "server");
  });
  const keys = store.numbers.filter((number) => store.people(number).size);
  const between = truth.slice(first, last).filter((_, index) => index % step !== 0);
  const persons = new Set(keys.flatMap((number) => [...store.people(number).keys()]));
  const counts = {
    filled: 0,
    near: 0,
    between: sizes(between),
    keyed: sizes(truth.slice(first, last + 1)) - sizes(between),
  };
  for (const person of persons) {
    for (const { frame, after } of filledBeside(store, scene, person, step)) {
      const there = truth[store.numbers.indexOf(frame)][person];
      if (there === undefined) continue; // nobody to compare with: the identity was lost for a moment
      counts.filled += 1;
      if (distance(scene, after.position, there) <= NEAR + 1e-9) counts.near += 1;
    }
  }
  return counts;
}

/** Only between neighbouring keyframes: who was away for longer is not what is measured. */
function filledBeside(store, scene, person, step) {
  const isHere = (index) => Boolean(store.person(person, store.numbers[index]));
  return fillEdits(store, scene, person).filter(({ frame }) => {
    const index = store.numbers.indexOf(frame);
    const before = [...Array(step).keys()].some((far) => isHere(index - far));
    const after = [...Array(step).keys()].some((far) => isHere(index + far));
    return before && after;
  });
}

function annotated(people) {
  return new Map(
    Object.entries(people).map(([person, position]) => [
      Number(person),
      annotation({ person: Number(person), position }),
    ]),
  );
}

function sizes(people) {
  return people.reduce((sum, one) => sum + Object.keys(one).length, 0);
}

function distance(scene, one, other) {
  const [from, to] = [scene.metres(one), scene.metres(other)];
  return Math.hypot(from.x - to.x, from.y - to.y);
}

function add(counts, more) {
  for (const name of Object.keys(counts)) counts[name] += more[name];
}
