import assert from "node:assert/strict";
import { test } from "node:test";
import { Draft } from "../../static/calibration/check/draft.js";
import { figuresOf, summary } from "../../static/calibration/check/figures.js";
import { pressed } from "../../static/calibration/keys.js";
import { Camera } from "../../static/geometry/camera.js";
import { pixelEllipse } from "../../static/geometry/pixel_ellipse.js";

const AHEAD = new Camera({
  index: 0,
  name: "C1",
  width: 1000,
  height: 1000,
  matrix: [
    [1000, 0, 500],
    [0, 1000, 500],
    [0, 0, 1],
  ],
  rotation: [
    [1, 0, 0],
    [0, 0, -1],
    [0, 1, 0],
  ], // looks along Y
  tvec: [0, 1, 0],
  distortion: [],
  grid: "",
});

test("the ± of a place is seen as long as it is, in the direction it has", () => {
  const found = pixelEllipse(
    AHEAD,
    [0, 10, 1],
    [
      [0.0004, 0, 0],
      [0, 1, 0],
      [0, 0, 0.0025],
    ],
  );
  assert.ok(found);
  // 5 cm and 2 cm at 10 m, a focal length of 1000 pixels; along the axis nothing is seen of it.
  assert.ok(Math.abs(found.major - 5) < 1e-3 && Math.abs(found.minor - 2) < 1e-3);
  assert.ok(Math.abs(Math.abs(found.turn) - 90) < 1e-3);
  assert.equal(
    pixelEllipse(
      AHEAD,
      [0, -10, 1],
      [
        [1, 0, 0],
        [0, 1, 0],
        [0, 0, 1],
      ],
    ),
    null,
  );
});

test("moving a click on is one step, another click is another", () => {
  const draft = new Draft();
  draft.put("C1", [1, 1], "click in C1");
  for (const x of [2, 3, 4]) draft.put("C1", [x, 1], "nudge in C1");
  draft.put("C2", [5, 5], "click in C2");
  draft.takeBack();
  assert.deepEqual(draft.clicks, { C1: [4, 1] });
  draft.takeBack();
  assert.deepEqual([draft.clicks, draft.redo], [{ C1: [1, 1] }, "nudge in C1"]);
  draft.doAgain();
  draft.put("C3", [0, 0], "click in C3");
  assert.equal(draft.redo, "");
});

test("one click has no place, and nothing is told of all together", () => {
  const found = figuresOf({ C1: [500, 500], C9: [1, 1] }, new Map([["C1", AHEAD]]));
  assert.deepEqual(found, { spot: null, views: {} });
  assert.deepEqual(summary([found]), { points: 0, clicks: 0, off: 0, median: null, p95: null, byCamera: {} });
});

test("Ctrl and Shift with Z do again, a digit chooses only a camera that is there", () => {
  /** @type {string[]} */
  const done = [];
  const keys = {
    actions: { undo: () => done.push("undo"), redo: () => done.push("redo"), fit: () => done.push("fit") },
    names: { f: "fit" },
    nudge: (/** @type {number} */ dx, /** @type {number} */ dy) => done.push(`${dx} ${dy}`),
    choose: (/** @type {number} */ index) => index === 0,
  };
  const plain = { ctrlKey: false, metaKey: false, shiftKey: false };
  assert.ok(pressed(keys, { ...plain, ctrlKey: true, key: "z" }));
  assert.ok(pressed(keys, { ...plain, ctrlKey: true, shiftKey: true, key: "Z" }));
  assert.ok(pressed(keys, { ...plain, key: "F" }));
  assert.ok(pressed(keys, { ...plain, shiftKey: true, key: "ArrowLeft" }));
  assert.ok(pressed(keys, { ...plain, key: "1" }));
  assert.ok(!pressed(keys, { ...plain, key: "2" }) && !pressed(keys, { ...plain, ctrlKey: true, key: "f" }));
  assert.deepEqual(done, ["undo", "redo", "fit", "-5 0"]);
});
