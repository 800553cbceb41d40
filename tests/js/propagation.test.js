import assert from "node:assert/strict";
import { test } from "node:test";
import { predictPeople } from "../../static/truth/propagation.js";
import { cell, grid, one, people } from "./plaza.js";

/** Column and row of everybody at `time` 1.5 s; sources are at 1.0, 0.5, 0 s. At 0 s: 0.5, 1.0, 1.5 s. */
function predicted(lists, options = {}, time = 1.5) {
  const sources = lists.map((list, index) => ({
    time: time > 0 ? 1 - index / 2 : index / 2 + 0.5,
    people: people(...list),
  }));
  return Object.fromEntries(predictPeople(grid, time, sources, options).map((each) => [each.person, cell(each)]));
}

test("who was seen once is carried over where he stood", () => {
  assert.deepEqual(predicted([[one(1, [20, 30])]]), { 1: [20, 30] });
});

test("who stood still stays", () => {
  assert.deepEqual(predicted([[one(1, [20, 30])], [one(1, [20, 30])]]), { 1: [20, 30] });
});

test("who walked is expected a little less than a step further", () => {
  assert.deepEqual(predicted([[one(1, [30, 30])], [one(1, [20, 34])]]), { 1: [39, 26] }); // 0.93 of (10, -4)
});

test("an evened out movement of three frames is continued", () => {
  const found = predicted([[one(1, [30, 30])], [one(1, [20, 30])], [one(1, [20, 30])]]);
  assert.deepEqual(found, { 1: [35, 30] }); // 0.93 of 1 / (1 + 0.8) of the last step
});

test("an evened out movement of four frames is continued", () => {
  const found = predicted([[one(1, [30, 30])], [one(1, [30, 30])], [one(1, [30, 30])], [one(1, [20, 30])]]);
  assert.deepEqual(found, { 1: [32, 30] }); // 0.93 of 0.64 / (1 + 0.8 + 0.64) of 10
});

test("who only seems to move stays: clicks are not better than half a position in half a second", () => {
  const found = predicted([[one(1, [21, 30])], [one(1, [20, 30])], [one(1, [20, 31])], [one(1, [20, 30])]]);
  assert.deepEqual(found, { 1: [21, 30] });
});

test("a step faster than people walk ends the movement before it", () => {
  const found = predicted([[one(1, [40, 30])], [one(1, [35, 30])], [one(1, [5, 30])], [one(1, [4, 30])]]);
  assert.deepEqual(found, { 1: [45, 30] });
});

test("going backwards, the movement is continued backwards", () => {
  assert.deepEqual(predicted([[one(1, [30, 30])], [one(1, [36, 30])]], {}, 0), { 1: [24, 30] });
});

test("nobody is expected to run faster than people walk", () => {
  const found = predicted([[one(1, [40, 30])], [one(1, [20, 30])]]); // 2 m in half a second: two people were mixed up
  assert.deepEqual(found, { 1: [40, 30] });
});

test("predictions stay on the grid", () => {
  assert.deepEqual(predicted([[one(1, [98, 78])], [one(1, [90, 70])]]), { 1: [99, 79] });
});

test("nobody is put onto somebody else's position", () => {
  const except = people(one(7, [20, 30]));
  const places = Object.values(predicted([[one(1, [20, 30]), one(2, [20, 30])]], { except }));
  assert.equal(new Set([...places, [20, 30]].map(String)).size, 3);
  for (const [column, row] of places) assert.ok(Math.abs(column - 20) <= 1 && Math.abs(row - 30) <= 1);
});

test("who is there already is not brought again", () => {
  const found = predicted([[one(1, [20, 30]), one(2, [50, 50])]], { except: people(one(1, [1, 1])) });
  assert.deepEqual(found, { 2: [50, 50] });
});

test("a carried person keeps the height and is to be looked at", () => {
  const sources = [{ time: 0, people: people(one(1, [5, 5], { height: 1.62, radius: 0.2 })) }];
  const [{ height, radius, state, origin }] = predictPeople(grid, 0.5, sources);
  assert.deepEqual([height, radius, state, origin], [1.62, 0.2, "carried", "carried"]);
});
