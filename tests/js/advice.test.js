import assert from "node:assert/strict";
import { test } from "node:test";
import { adviceFor, presses } from "../../static/workbench/tutorial/advice.js";

/** Rows lead away from the camera, columns to the left. */
const AXES = {
  left: { columns: 1, rows: 0 },
  right: { columns: -1, rows: 0 },
  up: { columns: 0, rows: 1 },
  down: { columns: 0, rows: -1 },
};
const label = (key) => ({ left: "←", right: "→", up: "↑", down: "↓" })[key];

test("the way is said in the keys of the view, most presses first", () => {
  assert.deepEqual(presses(AXES, -2, 5), [
    { key: "up", times: 5 },
    { key: "right", times: 2 },
  ]);
});

test("a short way is said in keys", () => {
  const words = adviceFor(presses(AXES, -2, 5), "C1", label);
  assert.equal(words, "Press ↑ 5× and → 2×, with the pointer over C1.");
});

test("a long way is said in words, for a click is quicker", () => {
  const words = adviceFor(presses(AXES, 4, -30), "C4", label);
  assert.equal(words, "Click with the right button between the feet: in C4 they are nearer and further left.");
});

test("who stands right is told nothing", () => {
  assert.equal(adviceFor(presses(AXES, 0, 0), "C1", label), "");
});
