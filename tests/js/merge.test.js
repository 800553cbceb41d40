import assert from "node:assert/strict";
import { test } from "node:test";
import { annotation } from "../../static/truth/annotation.js";
import { mergePeople } from "../../static/truth/merge.js";

const people = (places) =>
  new Map(
    Object.entries(places).map(([person, position]) => [
      Number(person),
      annotation({ person: Number(person), position }),
    ]),
  );

function merged(base, ours, theirs) {
  const found = mergePeople(people(base), people(ours), people(theirs));
  return {
    places: Object.fromEntries([...found.people].map(([person, { position }]) => [person, position])),
    renumber: found.renumber,
    conflicts: found.conflicts.map(({ person }) => person),
  };
}

for (const [base, ours, theirs, places] of [
  [
    { 1: 10, 2: 20 },
    { 1: 11, 2: 20 },
    { 1: 10, 2: 21 },
    { 1: 11, 2: 21 },
  ],
  [{ 1: 10, 2: 20 }, { 2: 20 }, { 1: 10, 2: 21 }, { 2: 21 }],
  [{ 1: 10 }, { 1: 10, 2: 5 }, {}, { 2: 5 }],
  [{ 1: 10 }, { 1: 12 }, { 1: 12 }, { 1: 12 }],
]) {
  test(`a merge takes each person from the side that changed it: ${JSON.stringify(places)}`, () => {
    assert.deepEqual(merged(base, ours, theirs), { places, renumber: [], conflicts: [] });
  });
}

for (const [how, ours, theirs] of [
  ["moved", { 1: 11 }, { 1: 12 }],
  ["removed", {}, { 1: 12 }],
  ["lost", { 1: 11 }, {}],
]) {
  test(`a merge asks when both sides changed the same person: ${how}`, () => {
    const found = merged({ 1: 10 }, ours, theirs);
    assert.deepEqual(found.conflicts, [1]);
    assert.deepEqual(found.places, ours);
  });
}

test("a number given twice means two people", () => {
  assert.deepEqual(merged({}, { 1: 10 }, { 1: 99 }), { places: { 1: 99 }, renumber: [1], conflicts: [] });
});
