import assert from "node:assert/strict";
import { test } from "node:test";
import {
  apart,
  driftBy,
  overlap,
  setBy,
  sharedTime,
  toldFrom,
  videoTime,
} from "../../static/calibration/sync/clocks.js";
import { meant } from "../../static/calibration/sync/keys.js";
import { layout } from "../../static/calibration/sync/tiles.js";
import { clockTime, inPictures, signed } from "../../static/calibration/sync/words.js";

const clock = (camera, offset, drift = 0) => ({ file: `${camera}.mp4`, camera, offset, drift, used: true });
const video = (camera, rate, duration = 600) => ({ file: `${camera}.mp4`, start: 0, interval: 1 / rate, duration });
/** What happens at these seconds of the true time is seen there in each video. */
const events = (times, ...clocks) =>
  times.map((time, at) => ({
    name: `Event ${at}`,
    marks: Object.fromEntries(clocks.map((each) => [each.file, videoTime(each, time)])),
  }));

test("an event tells how much later it comes, and setting by it brings it to one time", () => {
  const [reference, truth] = [clock("C1", 0), clock("C2", 1.25, 40)];
  const [event] = events([100], reference, truth);
  const guessed = { ...truth, offset: 1.21 };
  assert.ok(Math.abs(apart(event, guessed, reference) - 0.04) < 1e-5);
  const set = setBy(event, guessed, reference);
  assert.ok(Math.abs(set.offset - 1.25) < 1e-4);
  assert.equal(apart({ ...event, marks: { "C2.mp4": 3 } }, truth, reference), null);
});

test("two events far apart give offset and drift, and how sure they are; near ones give none", () => {
  const [reference, truth] = [clock("C1", 0), clock("C2", -2.5, 85)];
  const all = [video("C2", 60), video("C1", 30)];
  const told = driftBy(events([10, 510], reference, truth), clock("C2", 0), reference, ...all);
  assert.ok(Math.abs(told.clock.drift - 85) < 0.02);
  assert.ok(Math.abs(told.clock.offset + 2.5) < 1e-4);
  assert.ok(told.sigma > 25 && told.sigma < 40, String(told.sigma)); // half a picture in 500 s
  assert.equal(driftBy(events([10, 10.5], reference, truth), clock("C2", 0), reference, ...all), null);
});

test("told from another video, all still show the same instants together", () => {
  const clocks = [clock("C1", 0), clock("C2", 1.25, 40), clock("C3", -3, -25)];
  const moved = toldFrom(clocks, clocks[1]);
  assert.deepEqual([moved[1].offset, moved[1].drift], [0, 0]);
  const shared = videoTime(clocks[1], 300);
  for (const [at, each] of moved.entries())
    assert.ok(Math.abs(videoTime(each, shared) - videoTime(clocks[at], 300)) < 1e-5);
});

test("what all videos see is from the last begin to the first end", () => {
  const pairs = [
    { clock: clock("C1", 2), video: video("C1", 25, 20) },
    { clock: clock("C2", -1), video: video("C2", 25, 10) },
  ];
  assert.deepEqual(overlap(pairs), { from: 1, until: 11, last: "C2", first: "C2" });
  pairs[1].clock.offset = -30;
  const none = overlap(pairs);
  assert.ok(none.until < none.from);
  assert.deepEqual([none.last, none.first], ["C2", "C1"]);
  assert.equal(sharedTime(pairs[0].clock, 2), 0);
});

test("pictures are as large as they can be", () => {
  assert.equal(layout(2, 1256, 600, 16 / 9).columns, 2);
  assert.equal(layout(7, 1256, 400, 16 / 9).columns, 4);
  assert.equal(layout(9, 1900, 900, 16 / 9).columns, 3);
});

test("times and distances in words", () => {
  assert.deepEqual([clockTime(0), clockTime(-3.25), clockTime(3723.4)], ["0:00.000", "−0:03.250", "1:02:03.400"]);
  assert.deepEqual([signed(0.0384), signed(-12.4), signed(0.0001)], ["+38 ms", "−12.400 s", "0 ms"]);
  assert.deepEqual([inPictures(0.04, 0.04), inPictures(-0.06, 0.04)], ["1 picture", "−1.5 pictures"]);
});

test("keys mean the same on American and German keyboards", () => {
  const press = (key, more = {}) =>
    meant({ key, shiftKey: false, ctrlKey: false, altKey: false, metaKey: false, ...more });
  const shift = { shiftKey: true };
  assert.deepEqual([press(","), press("<", shift), press(";", shift)], ["earlier", "earlierTen", "earlierTen"]);
  assert.deepEqual([press("."), press(">", shift), press(":", shift)], ["later", "laterTen", "laterTen"]);
  assert.deepEqual([press("+"), press("="), press("-")], ["plus", "plus", "minus"]);
  assert.deepEqual([press("Z", { ctrlKey: true, ...shift }), press("z", { metaKey: true })], ["redo", "undo"]);
  assert.deepEqual([press("m", { altKey: true }), press("x")], [null, null]);
});
