import assert from "node:assert/strict";
import { test } from "node:test";
import { standing, walking } from "../../static/workbench/proposals/inheriting.js";
import { footFrom } from "../../static/workbench/sheet/fused_foot.js";
import { acceptAll, putAt, refuse } from "../../static/workbench/sheet/sheet_edits.js";
import { arrangeCells } from "../../static/workbench/sheet/sheet_layout.js";
import { extended, shownOf, slotsOf } from "../../static/workbench/sheet/slots.js";
import { tileViews } from "../../static/workbench/sheet/tile_views.js";
import { at, cell, frames, grid, one, YELLOW } from "./plaza.js";

/** Two views that look along the ground: each tells its own axis well (100 pixels a metre) and the other badly (5). */
const seeing = {
  toImage: (view, { x, y }) => (view === 0 ? { x: 100 * x, y: 5 * y } : { x: 100 * y, y: 5 * x }),
  toGround: (view, pixel) => (view === 0 ? { x: pixel.x / 100, y: pixel.y / 5 } : { x: pixel.y / 5, y: pixel.x / 100 }),
};

const proposal = (id, place, values = {}) => ({
  ...{ id, position: at(place), height: null, radius: null, score: 0.9, doubt: 0.1, track: id, person: null },
  ...values,
});

const frameOf = (people, open = [], persons = {}) => ({
  people: new Map(people.map((each) => [each.person, each])),
  open,
  personOf: ({ id }) => persons[id] ?? null,
  doubtful: ({ score }) => score < 0.5,
});

test("a click settles the direction its view is sure of, and leaves the other one as it was", () => {
  const foot = footFrom(seeing, { x: 0, y: 0, sigma: 0.1 }, [{ view: 0, pixel: { x: 10, y: 2 }, sigma: 1 }]);
  assert.ok(Math.abs(foot.x - 0.1) < 0.003, `${foot.x}`);
  assert.ok(foot.y > 0 && foot.y < 0.12, `${foot.y}`); // the click alone says 0.4
});

test("clicks in two views settle both directions, however far somebody was off", () => {
  const clicks = [
    { view: 0, pixel: { x: 200, y: -5 }, sigma: 1 },
    { view: 1, pixel: { x: -100, y: 10 }, sigma: 1 },
  ];
  const foot = footFrom(seeing, { x: 0, y: 0, sigma: 0.1 }, clicks);
  assert.ok(Math.hypot(foot.x - 2, foot.y + 1) < 0.002, JSON.stringify(foot));
});

test("a click above the horizon means no place", () => {
  const click = { view: 0, pixel: { x: 0, y: 0 }, sigma: 1 };
  assert.equal(footFrom({ ...seeing, toGround: () => null }, { x: 0, y: 0, sigma: 0.1 }, [click]), null);
});

test("of three views those two are shown that tell both directions, and hidden feet come last", () => {
  const box = { xmin: -20, ymin: -20, xmax: 20, ymax: 3000 };
  const front = { xmin: -1e4, ymin: -1e4, xmax: 1e4, ymax: 4000 };
  const scene = {
    cameras: ["A", "B", "C"].map((name) => ({ name, width: 4000, height: 4000 })),
    metres: () => ({ x: 20, y: 20 }),
    toImage: (view, ground) => seeing.toImage(view % 2, ground), // the third sees what the first one sees
    rectangles: (placed) => [placed.front ? front : box, box, box],
  };
  assert.deepEqual(tileViews(scene, {}, []).toSorted(), [0, 1]);
  assert.deepEqual(tileViews(scene, {}, [{ front: true }]).toSorted(), [1, 2]);
  const evidence = new Map([["A", { box: null, hidden: false }]]);
  assert.deepEqual(tileViews(scene, {}, [], evidence).toSorted(), [1, 2]);
});

test("the most doubtful come first, who is accepted last, and whoever was carried over to a proposal is in it", () => {
  const people = [one(1, [1, 1]), one(2, [5, 5], { ...YELLOW, origin: "carried" }), one(3, [9, 9], YELLOW)];
  const open = [proposal(10, [20, 20], { doubt: 0.2 }), proposal(11, [5, 6], { doubt: 0.9, score: 0.3 })];
  const frame = frameOf(people, open, { 11: 2 });
  const shown = slotsOf(frame).map((slot) => shownOf(slot, frame));
  assert.deepEqual(
    shown.map(({ person, state }) => [person, state]),
    [
      [2, "doubtful"],
      [3, "open"],
      [null, "open"],
      [1, "accepted"],
    ],
  );
});

test("everybody keeps their place when accepted or refused, and whoever comes is added behind", () => {
  const open = [proposal(10, [20, 20], { doubt: 0.5 }), proposal(11, [40, 40])];
  const slots = slotsOf(frameOf([], open));
  const later = frameOf([one(7, [20, 21]), one(8, [70, 70])], [], { 10: 7 });
  const shown = extended(slots, later).map((slot) => shownOf(slot, later));
  assert.deepEqual(
    shown.map(({ person, state }) => [person, state]),
    [
      [7, "accepted"],
      [null, "refused"],
      [8, "accepted"],
    ],
  );
});

/** Proposals that become people with numbers from 90 on. */
const proposing = {
  edits: (chosen, state) =>
    chosen.map(({ position, track }) => ({
      frame: 0,
      person: 90 + track,
      after: one(90 + track, [0, 0], { position, state, origin: "proposed" }),
    })),
};

test("accepting the rest is one step over proposals and yellow people", () => {
  const store = frames([one(1, [5, 5], YELLOW), one(2, [6, 6])]);
  const frame = frameOf([...store.people().values()], [proposal(3, [9, 9])]);
  const open = slotsOf(frame)
    .map((slot) => shownOf(slot, frame))
    .filter(({ state }) => state === "open");
  store.apply(acceptAll(store, proposing, open).edits);
  const everybody = [...store.people().values()].map(({ person, state, origin }) => [person, state, origin]);
  assert.deepEqual(everybody, [
    [1, "validated", "clicked"],
    [2, "validated", "clicked"],
    [93, "validated", "proposed"],
  ]);
});

test("a place clicked makes a proposal the annotator's, and brings back who was refused", () => {
  const store = frames([]);
  const frame = frameOf([], [proposal(3, [9, 9])]);
  const [slot] = slotsOf(frame);
  store.apply(putAt(store, proposing, shownOf(slot, frame), at([10, 9])).edits);
  const placed = store.person(93);
  assert.deepEqual([cell(placed), placed.state, placed.origin], [[10, 9], "validated", "clicked"]);
  store.apply([{ frame: 0, person: 93, after: null }]);
  const gone = shownOf(slot, frameOf([], [], { 3: 93 }));
  assert.equal(gone.state, "refused");
  store.apply(putAt(store, proposing, gone, at([11, 9])).edits);
  assert.deepEqual(cell(store.person(93)), [11, 9]);
});

test("refusing a proposal removes whoever was carried over to it, in the same step", () => {
  const store = frames([one(2, [5, 5], { ...YELLOW, origin: "carried" })]);
  const frame = frameOf([...store.people().values()], [proposal(11, [5, 6])], { 11: 2 });
  const [shown] = slotsOf(frame).map((slot) => shownOf(slot, frame));
  const step = refuse(store, shown);
  assert.deepEqual(step.refuses, { frame: 0, position: at([5, 6]) });
  assert.deepEqual(
    step.edits.map(({ person, after }) => [person, after]),
    [[2, null]],
  );
});

test("as many as fit are in sight at once, as large as possible; of more than that the sheet scrolls", () => {
  const room = { width: 1276, height: 690 };
  const few = arrangeCells(24, room);
  assert.ok(Math.ceil(24 / few.columns) * (few.height + 6) <= room.height, JSON.stringify(few));
  assert.ok(arrangeCells(6, room).width > few.width);
  const many = arrangeCells(200, room);
  assert.ok(many.width >= 200 && many.height >= 150, JSON.stringify(many));
});

const ground = { metres: (position) => grid.metres(position), positionAt: ({ x, y }) => grid.position(x, y) };

test("somebody who stands is proposed where they were put in another frame, and somebody who has moved is not", () => {
  const other = { proposal: proposal(1, [20, 20]), marked: at([22, 20]) };
  assert.deepEqual(cell(standing(proposal(2, [21, 20]), other, ground)), [23, 20]);
  assert.equal(standing(proposal(2, [26, 20]), other, ground), null);
  assert.equal(standing(proposal(2, [20, 20]), { ...other, marked: null }, ground), null);
});

test("somebody who walks is proposed nearer to the line between the steps, the more so the surer those are", () => {
  const beside = (place, marked = null) => ({ proposal: proposal(1, place), marked });
  const fine = { ...ground, positionAt: ({ x }) => x }; // not only whole positions
  const here = proposal(2, [42, 40]);
  const [loose, sure] = [null, at([50, 40])].map(
    (marked) => walking(here, beside([30, 40], marked && at([30, 40])), beside([50, 40], marked), fine).position,
  );
  const [middle, own] = [grid.metres(at([40, 40])).x, grid.metres(here.position).x];
  assert.ok(middle < sure && sure < loose && loose < own, `${middle} ${sure} ${loose} ${own}`);
  assert.equal(walking(proposal(2, [44, 40]), beside([30, 40]), beside([50, 40]), ground).position, at([44, 40]));
});
