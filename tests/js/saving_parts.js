/** What the tests of saving need: a server and a journal in memory, and people. */

import { ApiError, NetworkError } from "../../static/base/api.js";
import { Activity } from "../../static/saving/activity.js";
import { Saver } from "../../static/saving/saver.js";
import { annotation } from "../../static/truth/annotation.js";
import { Store } from "../../static/truth/store.js";

export const lost = () => {
  throw new NetworkError("no network");
};
export const refusedWith = (status, code, details) => () => {
  throw new ApiError(status, code, code, details);
};
/** What the server really says to a save it took. */
export const taken = (frame, { revision, annotations, done, nobody }) => ({
  number: frame,
  revision: revision + 1,
  annotations,
  done,
  nobody,
});

export function row(person, position) {
  return { ...annotation({ person, position }) };
}

export function state(number, revision, annotations, flags = {}) {
  return { number, revision, annotations, done: false, nobody: false, saved_at: null, author: "", ...flags };
}

class MemoryJournal {
  constructor() {
    this.records = new Map();
    this.keeps = true;
  }

  write(frame, record) {
    this.records.set(frame, structuredClone({ ...record(), frame }));
  }

  clear(frame) {
    this.records.delete(frame);
  }
}

/** A saver over frames 0, 1, 2 …; `answers` are given one after the other, then `answer`. */
export function saving({ frames = [state(0, 1, [row(1, 10)])], answer = taken, answers = [] } = {}) {
  let now = 0;
  const store = new Store(
    frames.map(({ number }) => number),
    100,
  );
  const saves = [];
  const api = {
    async saveFrame(frame, body) {
      saves.push({ frame, body: structuredClone(body) });
      return (answers.shift() ?? answer)(frame, body);
    },
  };
  const journal = new MemoryJournal();
  const activity = new Activity(() => now);
  const saver = new Saver({ api, store, journal, activity });
  frames.forEach((one) => saver.install(one));
  const move = (person, position, frame = 0) =>
    store.apply([{ frame, person, after: annotation({ person, position }) }]);
  const work = (seconds, frame = 0) => {
    now += seconds * 1000;
    activity.note(frame);
  };
  return {
    store,
    saver,
    saves,
    journal,
    activity,
    move,
    work,
    place: (person, frame = 0) => store.person(person, frame)?.position,
  };
}

/** An answer that is given when the test says so. */
export function later() {
  const asked = {};
  asked.promise = new Promise((give, fail) => Object.assign(asked, { give, fail }));
  return asked;
}

/** Everything that needs no clock happens. */
export async function settled() {
  for (let turn = 0; turn < 50; turn += 1) await Promise.resolve();
}
