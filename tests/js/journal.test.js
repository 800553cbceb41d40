import assert from "node:assert/strict";
import { mock, test } from "node:test";
import { Journal } from "../../static/saving/journal.js";
import { later, settled } from "./saving_parts.js";

/** A database that answers each write when the test says so. */
function keeping() {
  const writes = [];
  const database = {
    isOpen: true,
    replace(_store, value, keys) {
      writes.push({ value, keys, ...later() });
      return writes.at(-1).promise;
    },
  };
  const tab = { name: "mine", alive: new Set() };
  return { writes, database, journal: new Journal("layer", database, tab) };
}

test("an edit is written without a pause after the write before it, with all that came meanwhile", async () => {
  const { writes, journal } = keeping();
  let edits = 0;
  const edit = () => {
    edits += 1;
    journal.write(0, () => ({ edits }));
  };
  edit();
  await settled();
  edit();
  edit();
  await settled();
  assert.deepEqual(
    writes.map(({ value }) => value.edits),
    [1],
  );
  writes[0].give();
  await settled();
  assert.deepEqual(
    writes.map(({ value }) => value.edits),
    [1, 3],
  );
});

test("a record of another tab goes with the write that stands for it", async () => {
  const { writes, journal } = keeping();
  journal.takeOver({ layer: "layer", tab: "closed", frame: 0 });
  journal.write(0, () => ({}));
  await settled();
  assert.deepEqual(writes[0].keys, [["layer", "closed", 0]]);
  journal.takeOver({ layer: "layer", tab: "crashed", frame: 0 });
  writes[0].give();
  journal.clear(0);
  await settled();
  assert.deepEqual(writes[1].keys, [
    ["layer", "mine", 0],
    ["layer", "crashed", 0],
  ]);
});

test("a record of another tab stays while what stands for it could not be written", async () => {
  mock.method(console, "warn", () => {});
  const { writes, journal } = keeping();
  journal.takeOver({ layer: "layer", tab: "closed", frame: 0 });
  journal.write(0, () => ({}));
  await settled();
  writes[0].fail(new Error("no room"));
  await settled();
  journal.write(0, () => ({}));
  await settled();
  mock.restoreAll();
  assert.deepEqual(writes[1].keys, [["layer", "closed", 0]]);
});

test("edits that could not be written are not called kept, until they are", async () => {
  mock.method(console, "warn", () => {});
  const { writes, journal } = keeping();
  journal.write(0, () => ({}));
  await settled();
  writes[0].fail(new Error("no room"));
  await settled();
  assert.equal(journal.keeps, false);
  journal.write(0, () => ({}));
  await settled();
  writes[1].give();
  await settled();
  mock.restoreAll();
  assert.equal(journal.keeps, true);
});

test("a database that another version took over keeps nothing, and says so", () => {
  const { database, journal } = keeping();
  assert.equal(journal.keeps, true);
  database.isOpen = false;
  assert.equal(journal.keeps, false);
});
