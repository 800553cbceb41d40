import assert from "node:assert/strict";
import { test } from "node:test";
import { DeskStore } from "../../static/review/store.js";

const side = (person) => ({ person, position: person * 10, height: null, radius: null });
const matched = { kind: "matched", truth: side(1), found: side(7), distance: 0.02, before: null };
const missed = { kind: "missed", truth: side(2), found: null, distance: null, before: null };
const extra = { kind: "extra", truth: null, found: side(9), distance: null, before: null };

function frame(number, ...marks) {
  const counts = { truth: 0, found: 0, matched: 0, missed: 0, extra: 0, swapped: 0, moved: 0 };
  return { frame: number, ...counts, differences: 0, compared: true, marks };
}

function desk() {
  const frames = [frame(0, matched), frame(5, extra, matched), frame(10, missed, matched)];
  const worst = [
    [10, 0],
    [5, 0],
  ];
  return new DeskStore({ reference: "truth", references: [], frames, worst_first: worst });
}

test("one key goes through all differences, worst first, and begins anew after the last", () => {
  const store = desk();
  const way = [1, 1, 1].map((by) => [store.step(by), store.current, store.chosen.kind]);
  assert.deepEqual(way, [
    [true, 10, "missed"],
    [true, 5, "extra"],
    [true, 10, "missed"],
  ]);
});

test("backwards one comes to the last difference first", () => {
  const store = desk();
  store.step(-1);
  assert.equal(store.current, 5);
});

test("a difference counts as seen however one came to it", () => {
  const store = desk();
  assert.equal(store.unseen, 2);
  store.open(5);
  store.select(1);
  assert.equal(store.unseen, 1);
  store.select(2);
  assert.equal(store.unseen, 1);
  store.step(1);
  assert.deepEqual([store.current, store.unseen], [10, 0]);
});

test("people go by the worker's numbers, who was missed by the reference's", () => {
  const store = desk();
  store.open(10);
  assert.deepEqual(
    store.marks().map(({ shown }) => shown.person),
    [2, 7],
  );
});

test("without a difference there is nothing to go to", () => {
  const store = new DeskStore({ reference: null, references: [], frames: [frame(0, matched)], worst_first: [] });
  assert.equal(store.step(1), false);
  assert.equal(store.selection, null);
});
