import assert from "node:assert/strict";
import { afterEach, beforeEach, mock, test } from "node:test";
import { later, lost, refusedWith, row, saving, settled, state, taken } from "./saving_parts.js";

beforeEach(() => mock.timers.enable({ apis: ["setTimeout"] }));
afterEach(() => mock.timers.reset());

/** Let time pass in small steps, with everything that happens in between. */
async function pass(ms) {
  for (let passed = 0; passed < ms; passed += 100) {
    mock.timers.tick(100);
    await settled();
  }
}

test("an edit kept before its first send goes on from the revision it was made on", async () => {
  const before = saving({ frames: [state(0, 3, [row(1, 10)])] });
  before.move(1, 11);
  const after = saving({ frames: [state(0, 3, [row(1, 10)])] });
  after.saver.adopt(before.journal.records.get(0));
  await pass(1000);
  assert.equal(after.saves[0].body.revision, 3);
  assert.equal(after.saver.status().kind, "saved");
});

function withoutRevision(ours, more = {}) {
  const flags = { done: false, nobody: false };
  return {
    frame: 0,
    base: { annotations: [row(1, 10)], ...flags },
    ours: { annotations: ours, ...flags },
    sending: null,
    question: null,
    edits: 1,
    at: 0,
    ...more,
  };
}

test("an edit kept without a revision is put onto what the server has", async () => {
  const { saver, saves, place } = saving({ frames: [state(0, 4, [row(1, 10), row(2, 20)])] });
  saver.adopt(withoutRevision([row(1, 11)]));
  await pass(1000);
  assert.deepEqual([place(1), place(2)], [11, 20]);
  assert.equal(saves[0].body.revision, 4);
  assert.equal(saver.status().kind, "saved");
});

test("an edit kept without a revision of somebody the server has moved is asked about", async () => {
  const { saver } = saving({ frames: [state(0, 4, [row(1, 15)])] });
  saver.adopt(withoutRevision([row(1, 11)]));
  assert.deepEqual(
    saver.conflicts()[0].conflicts.map(({ person }) => person),
    [1],
  );
});

test("a save that was begun without a revision is made anew", async () => {
  const { saver, saves } = saving({ frames: [state(0, 4, [row(1, 10)])] });
  const body = {
    save_id: "old",
    revision: undefined,
    annotations: [row(1, 11)],
    done: false,
    nobody: false,
    seconds: 3,
  };
  saver.adopt(withoutRevision([row(1, 11)], { sending: { saveId: "old", body } }));
  await pass(1000);
  assert.equal(saves.length, 1);
  assert.equal(saves[0].body.revision, 4);
  assert.equal(saves[0].body.seconds, 3);
});

test("a flush waits for the save that is under way", async () => {
  const asked = later();
  const { saver, move } = saving({ answers: [() => asked.promise] });
  move(1, 11);
  await pass(800);
  let answered = null;
  saver.flush().then((saved) => (answered = saved));
  await settled();
  assert.equal(answered, null);
  asked.give(state(0, 2, []));
  await settled();
  assert.equal(answered, true);
});

test("a flush also sends what was edited while the save was under way", async () => {
  const asked = later();
  const { saver, move, saves } = saving({ answers: [() => asked.promise] });
  move(1, 11);
  await pass(800);
  move(1, 12);
  const flushed = saver.flush();
  asked.give(state(0, 2, []));
  assert.equal(await flushed, true);
  assert.equal(saves[1].body.annotations[0].position, 12);
});

test("a flush puts together what was saved elsewhere and sends it", async () => {
  const current = state(0, 2, [row(1, 10), row(2, 20)]);
  const { saver, move, saves } = saving({ answers: [refusedWith(412, "stale", { current })] });
  move(1, 11);
  assert.equal(await saver.flush(), true);
  assert.deepEqual(
    saves[1].body.annotations.map(({ position }) => position),
    [11, 20],
  );
});

test("a flush without network answers that not all is saved", async () => {
  const { saver, move, saves } = saving({ answer: lost });
  move(1, 11);
  assert.equal(await saver.flush(), false);
  assert.equal(saves.length, 1);
});

test("an edit made while the frame is fetched anew stays", async () => {
  const { saver, move, place } = saving();
  move(1, 11);
  saver.refresh(state(0, 2, [row(1, 10), row(2, 20)]));
  assert.deepEqual([place(1), place(2)], [11, 20]);
  assert.equal(await saver.flush(), true);
});

test("a frame fetched before a save was answered does not take its place", async () => {
  const { saver, move, place } = saving();
  move(1, 11);
  await saver.flush();
  saver.refresh(state(0, 1, [row(1, 10)]));
  assert.equal(place(1), 11);
  assert.equal(saver.revision(0), 2);
});

test("a frame fetched while a save is under way leaves the answer to that save", async () => {
  const asked = later();
  const { saver, move, place } = saving({ answers: [() => asked.promise] });
  move(1, 11);
  await pass(800);
  saver.refresh(state(0, 2, [row(1, 11)]));
  asked.give(state(0, 2, []));
  await pass(2000);
  assert.deepEqual([place(1), saver.revision(0), saver.status().kind], [11, 2, "saved"]);
});

for (const [what, answer] of [
  ["nothing", undefined],
  ["another program's JSON", { ok: true }],
]) {
  test(`an answer of ${what} is no receipt, and is asked for less and less often`, async () => {
    const { saver, move, saves } = saving({ answer: () => answer });
    move(1, 11);
    await pass(10_000);
    assert.equal(saver.status().kind, "server");
    assert.equal(saves.length, 4); // after 0.7, 1.7, 3.7 and 7.7 s
    assert.equal(new Set(saves.map(({ body }) => body.save_id)).size, 1);
  });
}

test("an error nobody foresaw is tried again like any other", async () => {
  mock.method(console, "error", () => {});
  const broken = () => {
    throw new SyntaxError("no JSON");
  };
  const { saver, move, saves } = saving({ answer: broken });
  move(1, 11);
  await pass(10_000);
  mock.restoreAll();
  assert.equal(saver.status().kind, "server");
  assert.equal(saves.length, 4);
});

test("a refusal that is not the server's own keeps trying", async () => {
  const { saver, move } = saving({ answers: [refusedWith(404, "unknown")] });
  move(1, 11);
  await pass(1000);
  assert.equal(saver.status().kind, "server");
  await pass(2000);
  assert.equal(saver.status().kind, "saved");
});

test("ten frames that fail together make one step of waiting longer", async () => {
  const frames = Array.from({ length: 10 }, (_, number) => state(number, 1, [row(1, 10)]));
  const { move, saves } = saving({ frames, answer: lost });
  for (const { number } of frames) move(1, 11, number);
  await pass(4500); // after 0.7, 1.7 and 3.7 s
  assert.equal(saves.length, 30);
});

for (const [status, code, details] of [
  [412, "stale", { current: state(0, 2, [row(1, 10), row(2, 20)]) }],
  [400, "invalid", [{ place: "annotations", reason: "wrong" }]],
  [409, "save_id_used", null],
]) {
  test(`active seconds of a save answered with ${status} travel with the next one, once`, async () => {
    const { move, saves, work } = saving({ answers: [refusedWith(status, code, details)] });
    work(20);
    work(20);
    work(20);
    move(1, 11);
    await pass(3000);
    work(0.5);
    move(1, 12);
    await pass(3000);
    const counted = saves.slice(1).reduce((sum, { body }) => sum + body.seconds, 0);
    assert.equal(Math.round(counted * 10) / 10, 60.5);
  });
}

test("active seconds of a save that is sent again count once", async () => {
  const { move, saves, work } = saving({ answers: [lost] });
  work(20);
  move(1, 11);
  await pass(800);
  work(5);
  move(1, 12);
  await pass(5000);
  assert.deepEqual(
    saves.map(({ body }) => body.seconds),
    [20, 20, 5],
  );
});

test("active seconds survive the page that counted them", async () => {
  const before = saving();
  before.work(20);
  before.move(1, 11);
  const after = saving();
  after.saver.adopt(before.journal.records.get(0));
  await pass(1000);
  assert.equal(after.saves[0].body.seconds, 20);
});

test("a tenth of a second that was not sent yet is sent later", async () => {
  const { move, saves, work, saver } = saving();
  for (let time = 0; time < 10; time += 1) {
    work(0.04);
    move(1, 11 + time);
    await saver.flush();
  }
  const counted = saves.reduce((sum, { body }) => sum + body.seconds, 0);
  assert.equal(Math.round(counted * 10) / 10, 0.4);
});

test("a refused save is not sent again after a reload, but made anew", async () => {
  const before = saving({ answer: refusedWith(400, "invalid", []) });
  before.move(1, 11);
  await pass(1000);
  assert.equal(before.journal.records.get(0).sending, null);
});

test("after a reload a person added here keeps its number in all frames when another takes it", async () => {
  const frames = [state(0, 1, []), state(1, 1, [])];
  const before = saving({ frames });
  before.move(5, 50, 1);
  await before.saver.flush();
  before.move(5, 51, 1);
  before.move(5, 50, 0);
  const current = state(0, 2, [row(5, 77)]);
  const after = saving({
    frames: [frames[0], state(1, 2, [row(5, 50)])],
    answers: [(frame, body) => (frame === 0 ? refusedWith(412, "stale", { current })() : taken(frame, body))],
  });
  after.saver.adopt(before.journal.records.get(0));
  after.saver.adopt(before.journal.records.get(1));
  await pass(3000);
  assert.deepEqual(
    [after.place(5, 0), after.place(100, 0), after.place(5, 1), after.place(100, 1)],
    [77, 50, undefined, 51],
  );
});
