import assert from "node:assert/strict";
import { test } from "node:test";
import { History } from "../../static/truth/history.js";
import { Snapping } from "../../static/workbench/proposals/snapping.js";
import { at, frames, one, scene } from "./plaza.js";

/** A page whose server answers `answer`, a value or what makes one; `said` is what the annotator reads. */
function page(store, answer) {
  const [asked, said] = [[], []];
  const history = new History(store);
  const ask = async (_method, _path, body) => {
    asked.push(body);
    return typeof answer === "function" ? answer() : answer;
  };
  const guard = { editable: true, selected: () => store.selected() ?? null };
  const notices = { say: (text) => said.push(text) };
  const snapping = new Snapping({ api: { ask }, scene, store, history, notices, guard });
  return { snapping, history, store, asked, said };
}

const two = () => frames([one(7, [10, 10]), one(8, [30, 10])]);
const moved = { position: at([12, 10]), metres: 0.05, gain: 1, refused: "", background: true };
const place = ({ store }, person) => store.person(person, store.current).position;

test("a click moves to what the server says, with everybody else told, and one undo brings the click back", async () => {
  const here = page(two(), moved);
  await here.snapping.settle(7);
  assert.equal(place(here, 7), at([12, 10]));
  assert.equal(here.asked[0].position, at([10, 10]));
  assert.deepEqual(
    here.asked[0].others.map(({ position }) => position),
    [at([30, 10])],
  );
  assert.equal(here.said.length, 1);
  here.history.undo();
  assert.equal(place(here, 7), at([10, 10]));
});

test("whoever asks by key is told why somebody stays; whoever clicks is not", async () => {
  const here = page(two(), { position: at([10, 10]), metres: 0, gain: 0, refused: "near", background: true });
  here.store.select(7);
  await here.snapping.settle(7);
  assert.deepEqual(here.said, []);
  await here.snapping.table().snap();
  assert.equal(here.said.length, 1);
  assert.equal(place(here, 7), at([10, 10]));
});

test("an answer that comes too late for what was done meanwhile changes nothing", async () => {
  const here = page(two(), () => {
    here.store.apply([{ frame: here.store.current, person: 7, before: here.store.person(7, 0), after: null }]);
    return moved;
  });
  await here.snapping.settle(7);
  assert.equal(here.store.person(7, here.store.current), undefined);
});

test("nobody is moved onto somebody else who came meanwhile, and no answer moves nobody", async () => {
  const onto = page(two(), { ...moved, position: at([30, 10]) });
  await onto.snapping.settle(7);
  assert.equal(place(onto, 7), at([10, 10]));
  const silent = page(two(), () => Promise.reject(new Error("offline")));
  silent.store.select(7);
  await silent.snapping.table().snap();
  assert.equal(place(silent, 7), at([10, 10]));
  assert.equal(silent.said.length, 1);
});

test("a double click takes back its own move, and nothing that was done since", async () => {
  const here = page(two(), moved);
  await here.snapping.settle(7);
  here.snapping.takeBack();
  assert.equal(place(here, 7), at([10, 10]));
  here.snapping.takeBack();
  assert.equal(here.store.people().size, 2);
});
