import assert from "node:assert/strict";
import { test } from "node:test";
import { nearestSide, withFreeNumbers } from "../../static/truth/sources.js";
import { nextTask } from "../../static/truth/todo.js";
import { frames, one, scene, YELLOW } from "./plaza.js";

function task(current, ...all) {
  const store = frames(...all);
  store.open(current);
  return nextTask(store, false);
}

test("numbers of another batch are kept only where they are free", () => {
  const brought = [one(7, [1, 1]), one(80, [2, 2]), one(60, [3, 3])];
  assert.deepEqual(
    withFreeNumbers(frames([]), brought).map(({ person }) => person),
    [81, 80, 60],
  );
});

test("people come from the nearer side", () => {
  const store = frames([one(1, [1, 1])], [], [], [one(2, [2, 2])], []);
  const sides = [5, 10, 20].map((number) => nearestSide(store, scene, number).map((source) => source.number));
  assert.deepEqual(sides, [[0], [15], [15, 0]]);
});

test("a yellow person here comes first", () => {
  const found = task(0, [one(1, [1, 1]), one(2, [2, 2], YELLOW)], [one(1, [1, 1], YELLOW)]);
  assert.deepEqual([found.kind, found.number, found.person], ["person", 0, 2]);
});

test("then the next frame with something left", () => {
  const found = task(0, [one(1, [1, 1])], [one(1, [1, 1])], [one(1, [1, 1], YELLOW)]);
  assert.deepEqual([found.kind, found.number, found.person], ["person", 10, 1]);
});

test("frames before this one are not forgotten", () => {
  const found = task(10, [], [one(1, [1, 1])], [one(1, [1, 1])]);
  assert.deepEqual([found.kind, found.number, found.left], ["frame", 0, "empty"]);
});

test("somebody in one frame only is pointed out last", () => {
  const found = task(0, [one(1, [1, 1])], [one(1, [1, 1]), one(2, [5, 5])], [one(1, [1, 1])]);
  assert.deepEqual([found.kind, found.number, found.person], ["single", 5, 2]);
});

test("when all is done there is nothing left", () => {
  assert.equal(task(0, [one(1, [1, 1])], [one(1, [1, 1])]), null);
});
