import assert from "node:assert/strict";
import { test } from "node:test";
import { annotation, asList } from "../../static/truth/annotation.js";
import { move, place, remove } from "../../static/truth/commands.js";
import { History } from "../../static/truth/history.js";
import { Store } from "../../static/truth/store.js";

test("undo takes back everything, and redo brings it all again", () => {
  const store = new Store([0, 5], 1);
  const history = new History(store);
  const seen = [];
  const look = () => seen.push(JSON.stringify([asList(store.people(0)), asList(store.people(5))]));
  const step = (patch) => {
    history.run({ ...patch, group: null });
    look();
  };
  look();
  step(place(store, { position: 10 }));
  step(place(store, { position: 20 }));
  step(move(store, 1, 11));
  store.open(5);
  step(place(store, { position: 30 }));
  store.open(0);
  step(remove(store, 1));
  const there = [...seen];
  while (history.undo()) look();
  const back = seen.slice(there.length);
  while (history.redo()) look();
  assert.deepEqual(back, there.slice(0, -1).reverse());
  assert.deepEqual(seen.slice(there.length + back.length), there.slice(1));
});

test("a removed validation takes the done mark away, and undo restores it", () => {
  const store = new Store([0], 1);
  const history = new History(store);
  store.install(0, { people: new Map([[1, annotation({ person: 1, position: 4 })]]), done: true }, "server");
  const seen = [store.frame().done];
  history.run(remove(store, 1));
  seen.push(store.frame().done);
  history.undo();
  seen.push(store.frame().done);
  assert.deepEqual(seen, [true, false, true]);
});
