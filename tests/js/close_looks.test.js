import assert from "node:assert/strict";
import { test } from "node:test";
import { annotation } from "../../static/truth/annotation.js";
import { CloseLooks } from "../../static/workbench/people/close_looks.js";

/** A frame whose people change, and views that zoom. */
function workbench() {
  const listeners = {};
  const heard = (name, listener) => (listeners[name] = listener);
  const people = new Map();
  const store = {
    current: 1,
    selection: null,
    people: () => people,
    person: (person) => people.get(person),
    on: heard,
  };
  const panes = { zoomed: false, on: heard };
  const looks = new CloseLooks({ store, panes });
  return {
    looks,
    put(person, position, values = {}) {
      people.set(person, annotation({ person, position, ...values }));
      listeners.change({ frames: new Set([store.current]), source: "edit" });
    },
    select(person, zoomed) {
      store.selection = person;
      panes.zoomed = zoomed;
      listeners.selection();
    },
  };
}

test("whoever is clicked in the overview waits for a close look", () => {
  const { looks, put } = workbench();
  put(1, 500);
  assert.equal(looks.waits(1), true);
  assert.equal(looks.count, 1);
});

test("selected while the views are zoomed they are seen", () => {
  const { looks, put, select } = workbench();
  put(1, 500);
  select(1, true);
  assert.equal(looks.waits(1), false);
});

test("selected from afar they still wait", () => {
  const { looks, put, select } = workbench();
  put(1, 500);
  select(1, false);
  assert.equal(looks.waits(1), true);
});

test("whoever is placed close up does not wait", () => {
  const { looks, put, select } = workbench();
  select(null, true);
  put(1, 500);
  assert.equal(looks.waits(1), false);
});

test("people carried over and accepted proposals do not wait", () => {
  const { looks, put } = workbench();
  put(1, 500, { state: "carried", origin: "carried" });
  put(2, 700, { origin: "proposed" });
  assert.equal(looks.count, 0);
});

test("moved away again by something else they no longer wait", () => {
  const { looks, put, select } = workbench();
  put(1, 500);
  select(null, true);
  put(1, 501);
  assert.equal(looks.waits(1), false);
});
