import assert from "node:assert/strict";
import { test } from "node:test";
import { fill, move, remove, validate } from "../../static/truth/commands.js";
import { History } from "../../static/truth/history.js";
import { fillEdits, withRefill } from "../../static/truth/keyframes.js";
import { at, cell, frames, one, scene } from "./plaza.js";

const filled = (...all) => fillEdits(frames(...all), scene, 1);
const historyOf = (store) => new History(store, (patch) => withRefill(store, scene, patch));

test("between keyframes people walk on the straight line", () => {
  const edits = filled([one(1, [10, 10])], [], [], [one(1, [40, 16])]);
  assert.deepEqual(
    edits.map(({ frame, after }) => [frame, cell(after), after.state, after.origin]),
    [
      [5, [20, 12], "carried", "interpolated"],
      [10, [30, 14], "carried", "interpolated"],
    ],
  );
});

test("filling keeps the height", () => {
  const edits = filled([one(1, [10, 10], { height: 1.5 })], [], [one(1, [20, 10], { height: 1.5 })]);
  assert.deepEqual(
    edits.map(({ after }) => after.height),
    [1.5],
  );
});

test("validated people are never filled over", () => {
  assert.deepEqual(filled([one(1, [10, 10])], [one(1, [50, 50])], [one(1, [30, 10])]), []);
});

test("carried people between keyframes are put on the line", () => {
  const carried = one(1, [11, 10], { state: "carried", origin: "carried" });
  const edits = filled([one(1, [10, 10])], [carried], [one(1, [30, 10])]);
  assert.deepEqual(
    edits.map(({ frame, after }) => [frame, cell(after)]),
    [[5, [20, 10]]],
  );
});

test("somebody standing on the line is walked around", () => {
  const [edit] = filled([one(1, [10, 10])], [one(2, [20, 10])], [one(1, [30, 10])]);
  const [column, row] = cell(edit.after);
  assert.equal(Math.max(Math.abs(column - 20), Math.abs(row - 10)), 1);
});

test("a moved keyframe takes what was filled beside it along, and one undo takes all back", () => {
  const store = frames([one(1, [10, 10])], [], [], [], [one(1, [50, 10])]);
  const history = historyOf(store);
  const places = () => store.numbers.map((number) => cell(store.person(1, number)));
  history.run(fill(store, fillEdits(store, scene, 1)));
  store.open(10);
  history.run(validate(store, [1])); // looked at: it stays, and nothing beyond it changes
  store.open(0);
  const before = places();
  assert.deepEqual(before, [
    [10, 10],
    [20, 10],
    [30, 10],
    [40, 10],
    [50, 10],
  ]);
  history.run(move(store, 1, at([10, 30])));
  assert.deepEqual(places(), [
    [10, 30],
    [20, 20],
    [30, 10],
    [40, 10],
    [50, 10],
  ]);
  history.undo();
  assert.deepEqual(places(), before);
});

test("a keyframe taken away lets the line go straight", () => {
  const store = frames([one(1, [10, 10])], [], [one(1, [30, 50])], [], [one(1, [50, 10])]);
  const history = historyOf(store);
  history.run(fill(store, fillEdits(store, scene, 1)));
  store.open(10);
  history.run(remove(store, 1));
  const places = store.numbers.map((number) => store.person(1, number)).map((each) => each && cell(each));
  assert.deepEqual(places, [[10, 10], [20, 10], undefined, [40, 10], [50, 10]]);
});
