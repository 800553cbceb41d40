import assert from "node:assert/strict";
import { test } from "node:test";
import { move, remove } from "../../static/truth/commands.js";
import { History } from "../../static/truth/history.js";
import { evidenceWords } from "../../static/workbench/proposals/proposal_marks.js";
import { Proposals } from "../../static/workbench/proposals/proposals.js";
import { at, cell, frames, one, scene, YELLOW } from "./plaza.js";

let made = 0;

/** Somebody proposed at [column, row]. */
function proposed(place, values = {}) {
  made += 1;
  return {
    id: made,
    position: at(place),
    height: null,
    radius: null,
    score: 0.9,
    doubt: 0.1,
    track: made,
    person: null,
    seated: false,
    filled: false,
    evidence: [],
    ...values,
  };
}

/** A page of frames 0, 5 … with people in them and others proposed; what the server was told is in `told`. */
function page(store, lists, refused = []) {
  const told = [];
  const history = new History(store);
  const api = { ask: async (_method, _path, body) => void told.push(body) };
  const answer = {
    run: 1,
    threshold: 0.5,
    frames: lists.map((people, index) => ({ number: 5 * index, people, refused: index ? [] : refused })),
  };
  const session = { api, scene: { ...scene, editable: true }, store, history };
  return { proposals: new Proposals(session, answer, 0.5), history, store, told };
}

const settled = () => new Promise((done) => setTimeout(done));

test("nothing is in the store before somebody accepts, and undo takes all of it back", () => {
  const { proposals, history, store } = page(frames([]), [[proposed([10, 10]), proposed([30, 10])]]);
  assert.equal(store.people().size, 0);
  proposals.accept(proposals.likely);
  assert.deepEqual(
    [...store.people().values()].map(({ person, state, origin }) => [person, state, origin]),
    [
      [50, "validated", "proposed"],
      [51, "validated", "proposed"],
    ],
  );
  assert.equal(proposals.open.length, 0);
  history.undo();
  assert.equal(store.people().size, 0);
  assert.equal(proposals.open.length, 2);
});

test("the threshold says who is likely and who is doubtful, the most doubtful first", () => {
  const list = [
    proposed([10, 10]),
    proposed([30, 10], { score: 0.4, doubt: 0.6 }),
    proposed([50, 10], { score: 0.6, doubt: 0.4 }),
  ];
  const { proposals } = page(frames([]), [list]);
  assert.deepEqual(proposals.likely, [list[2], list[0]]);
  assert.deepEqual(proposals.open, [list[1], list[2], list[0]]);
  proposals.threshold = 0.7;
  assert.deepEqual(proposals.doubtful, [list[1], list[2]]);
});

test("whoever stands at a proposal explains it; whom the program carried over does not", () => {
  const list = [proposed([10, 10]), proposed([30, 10])];
  const guess = one(2, [30, 10], { ...YELLOW, origin: "carried" });
  const { proposals } = page(frames([one(1, [12, 10]), guess]), [list]);
  assert.deepEqual(proposals.open, [list[1]]);
});

test("a track keeps its number from frame to frame, also after somebody was carried over", () => {
  const [first, second] = [proposed([10, 10], { track: 7 }), proposed([16, 10], { track: 7 })];
  const { proposals, store } = page(frames([], []), [[first], [second]]);
  proposals.accept([first]);
  const guess = one(50, [12, 10], { ...YELLOW, origin: "carried" });
  store.install(5, { people: new Map([[50, guess]]) }, "server");
  store.open(5);
  proposals.accept(proposals.likely);
  const people = [...store.people(5).values()];
  assert.deepEqual(
    people.map(({ person, state }) => [person, state]),
    [[50, "validated"]],
  );
  assert.deepEqual(cell(people[0]), [16, 10]);
});

test("somebody carried over who stands near is taken for the one proposed", () => {
  const { proposals, store } = page(frames([one(4, [13, 10], { ...YELLOW, origin: "carried" })]), [
    [proposed([10, 10])],
  ]);
  proposals.accept(proposals.likely);
  assert.deepEqual([...store.people().keys()], [4]);
});

test("two tracks of one person do not become the same person twice in a frame", () => {
  const list = [proposed([10, 10], { track: 1, person: 9 }), proposed([40, 40], { track: 2, person: 9 })];
  const { proposals, store } = page(frames([]), [list]);
  proposals.accept(proposals.likely);
  assert.equal(store.people().size, 2);
});

test("a refusal is remembered on the server, and undo takes it back there", async () => {
  const list = [proposed([10, 10])];
  const { proposals, history, told } = page(frames([]), [list]);
  proposals.refuse(list[0]);
  assert.deepEqual(proposals.open, []);
  await settled();
  history.undo();
  assert.deepEqual(proposals.open, list);
  await settled();
  history.redo();
  await settled();
  const place = { frame: 0, position: list[0].position };
  assert.deepEqual(
    told,
    [true, false, true].map((refused) => ({ ...place, refused })),
  );
});

test("a refusal the server cannot be told of is told with the next step", async () => {
  const list = [proposed([10, 10]), proposed([30, 10])];
  const { proposals, told } = page(frames([]), [list]);
  const { ask } = proposals._api;
  proposals._api.ask = async () => Promise.reject(new Error("away"));
  proposals.refuse(list[0]);
  await settled();
  proposals._api.ask = ask;
  proposals.refuse(list[1]);
  await settled();
  assert.equal(told.length, 2);
});

test("what was refused before is not shown, nor what moved a little since", () => {
  const { proposals } = page(frames([]), [[proposed([12, 10]), proposed([30, 10])]], [at([10, 10])]);
  assert.equal(proposals.open.length, 1);
});

test("removing somebody who was proposed refuses the proposal", async () => {
  const { proposals, history, store, told } = page(frames([]), [[proposed([10, 10])]]);
  proposals.accept(proposals.likely);
  history.run(remove(store, 50));
  assert.deepEqual(proposals.open, []);
  await settled();
  assert.equal(told.length, 1);
});

test("a proposal that is moved is the annotator's", () => {
  const { proposals, history, store } = page(frames([]), [[proposed([10, 10])]]);
  proposals.accept(proposals.likely);
  history.run(move(store, 50, at([11, 10])));
  assert.equal(store.person(50).origin, "clicked");
});

test("doubtful ones are taken up as yellow people", () => {
  const { proposals, store } = page(frames([]), [[proposed([10, 10], { score: 0.3 })]]);
  proposals.takeUp(proposals.doubtful);
  assert.deepEqual(
    [...store.people().values()].map(({ state, origin }) => [state, origin]),
    [["carried", "proposed"]],
  );
});

test("evidence says which views found somebody, which could not, and which should have", () => {
  const view = (camera, values) => ({ camera, box: null, seen: null, hidden: false, ...values });
  const evidence = [
    view("C1", { box: [1, 2, 3, 4] }),
    view("C2", { hidden: true }),
    view("C3", { seen: 0.1 }),
    view("C4", { seen: 0.9 }),
  ];
  assert.deepEqual(evidenceWords(proposed([1, 1], { evidence }), 12).slice(1), [
    "found in C1",
    "differs from the background in C4",
    "hidden in C2",
    "not seen in C3",
  ]);
});
