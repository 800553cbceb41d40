import assert from "node:assert/strict";
import { test } from "node:test";
import { annotation } from "../../static/truth/annotation.js";
import { bestViews } from "../../static/views/crops.js";
import { arrange } from "../../static/views/layout.js";
import { kindOfStep, trail } from "../../static/views/paths.js";
import { Transform } from "../../static/views/transform.js";
import { Queue } from "../../static/workbench/people/queue.js";
import { at, frames, one, scene, YELLOW } from "./plaza.js";

test("zooming keeps the point under the pointer", () => {
  const before = new Transform(0.3, 12, 40);
  const source = before.toSource(200, 120);
  for (const { x, y } of [before.zoomAt(3.7, 200, 120), before].map((each) => each.toPane(source.x, source.y))) {
    assert.ok(Math.hypot(x - 200, y - 120) < 1e-9);
  }
});

for (const [width, height, expected] of [
  [1920, 1044, [3, 3, "cell"]],
  [1280, 764, [3, 3, "cell"]],
  [5120, 1400, [4, 2, "column"]],
]) {
  test(`panes of ${width} × ${height} are laid out so that pictures come out largest`, () => {
    const { columns, rows, panel } = arrange(8, { width, height }, 16 / 9);
    assert.deepEqual([columns, rows, panel], expected);
  });
}

test("steps of a path are told apart", () => {
  const store = frames([one(1, [1, 1])], [one(1, [2, 2])], [one(1, [3, 3], YELLOW)], [], [one(1, [4, 4])]);
  const steps = trail(store, 1);
  const kinds = steps.slice(1).map((step, index) => kindOfStep(store, steps[index], step));
  assert.deepEqual(kinds, ["validated", "carried", "missing"]);
});

test("the views that show a person whole and tall are chosen", () => {
  const box = (xmin, ymin, xmax, ymax) => ({ xmin, ymin, xmax, ymax });
  const boxes = [box(10, 10, 30, 60), null, box(90, 10, 150, 210), box(10, 10, 40, 90), box(10, 10, 20, 40)];
  const seen = { cameras: boxes.map(() => ({ width: 100, height: 100 })), rectangles: () => boxes };
  assert.deepEqual(bestViews(seen, [one(1, [1, 1])], 3), [0, 3, 4]);
});

test("yellow people come nearest first and keep their turn", () => {
  const places = [one(1, [0, 0]), one(2, [50, 0]), one(3, [10, 0]), one(4, [60, 0])];
  const store = frames(places.map((each) => annotation({ ...each, state: "carried" })));
  const queue = new Queue({ scene, store });
  const turns = (from) => {
    const found = [];
    for (let next = queue.next(from); found.length < 4; next = queue.next(next.person)) found.push(next.person);
    return found;
  };
  assert.deepEqual(turns(null), [1, 3, 2, 4]);
  const moved = annotation({ ...store.person(3), position: at([58, 0]) });
  store.apply([{ frame: 0, person: 3, after: moved }]);
  assert.deepEqual(turns(null), [1, 3, 2, 4]);
  assert.deepEqual(turns(3), [2, 4, 1, 3]);
});
