import { asList, byPerson, carriedOf } from "./annotation.js";
import { ApiError, NetworkError } from "./api.js";
import { Emitter } from "./emitter.js";
import { uuid4 } from "./identifiers.js";
import { mergeFlag, mergePeople, samePeople } from "./merge.js";

const DELAY = 700; // ms from an edit to its save
const SLOWEST_RETRY = 30_000;

/**
 * Saves whole frames. What has been sent is sent again, unchanged and under the same save id, until it is
 * answered: an answer lost on the way can then never look like somebody else's edit.
 *
 * Events: `status` (look at `status()`), `conflict` {frame, conflicts}.
 */
export class Saver extends Emitter {
  /** @param {{practice: boolean}} parts in practice (the tutorial) nothing is saved */
  constructor({ api, store, journal, activity, practice = false }) {
    super();
    this._api = api;
    this._store = store;
    this._journal = journal;
    this._activity = activity;
    this._slots = new Map();
    this._trouble = null; // "offline" | "server" | "signed_out"
    this._retry = 0;
    this._timer = null;
    this._readOnly = null;
    if (!practice) store.on("change", ({ frames, source }) => this._onChange(frames, source));
  }

  /** Take the server's state of a frame as the base of the next edits. */
  install(state) {
    this._slots.set(state.number, { base: baseOf(state), sending: null, busy: false, edits: 0, conflicts: null, refused: null });
    this._store.install(state.number, baseOf(state), "server");
  }

  /** Edits of an earlier visit that the server may not have: they go on from where they started. */
  adopt(record) {
    const slot = this._slots.get(record.frame);
    if (!slot) return;
    const ours = stateOf(record.ours);
    if (slot.edits === 0) {
      slot.base = { revision: record.base.revision, ...stateOf(record.base) };
      slot.sending = record.sending ? { ...record.sending, edits: record.edits } : null;
      this._store.install(record.frame, ours, "journal");
    } else {
      const now = this._store.frame(record.frame);
      const { people } = mergePeople(stateOf(record.base).people, now.people, ours.people);
      this._store.install(record.frame, { ...now, people }, "journal");
    }
    slot.edits += record.edits;
    this._keep(record.frame, slot);
    this._schedule(0);
  }

  revision(frame) {
    return this._slots.get(frame)?.base.revision ?? 0;
  }

  get unsaved() {
    let edits = 0;
    for (const slot of this._slots.values()) edits += slot.edits;
    return edits;
  }

  /** @returns {Set<number>} frames with edits the server has not acknowledged */
  unsavedFrames() {
    return new Set([...this._slots].filter(([, { edits }]) => edits > 0).map(([frame]) => frame));
  }

  /** @returns {{kind: "saved"|"saving"|"offline"|"server"|"signed_out"|"conflict"|"refused"|"read_only", unsaved, …}} */
  status() {
    const unsaved = this.unsaved;
    const slots = [...this._slots.values()];
    if (this._readOnly !== null) return { kind: "read_only", reason: this._readOnly, unsaved };
    if (slots.some((slot) => slot.conflicts)) return { kind: "conflict", unsaved };
    const refused = slots.find((slot) => slot.refused);
    if (refused) return { kind: "refused", reason: refused.refused, unsaved };
    if (this._trouble) return { kind: this._trouble, unsaved, kept: this._journal.keeps };
    return { kind: unsaved ? "saving" : "saved", unsaved };
  }

  /** Why nothing may be changed, or null. */
  get readOnly() {
    return this._readOnly;
  }

  makeReadOnly(reason) {
    this._readOnly = reason;
    this.emit("status");
  }

  /** Save at once; resolves when everything that could be sent has been answered. */
  async flush() {
    clearTimeout(this._timer);
    this._timer = null;
    await Promise.all([...this._slots.keys()].map((frame) => this._send(frame)));
    this.emit("status");
    return this.unsaved === 0;
  }

  /** The page goes away: the browser delivers these on its own; the journal has them too. */
  sendOnLeaving() {
    for (const [frame, slot] of this._slots) {
      if (slot.edits && !slot.busy) this._send(frame, { keepalive: true });
    }
  }

  /** Try again now: the network is back, or the annotator has signed in in another tab. */
  wake() {
    this._retry = 0;
    if (this.unsaved) this._schedule(0);
  }

  /** The annotator decided: per person, "ours" or "theirs". */
  resolve(frame, choices) {
    const slot = this._slots.get(frame);
    const edits = slot.conflicts
      .filter(({ person }) => choices.get(person) === "theirs")
      .map(({ person, theirs }) => ({ frame, person, after: theirs ?? null }));
    slot.conflicts = null;
    this._store.apply(edits);
    this._settle(frame, slot);
  }

  _onChange(frames, source) {
    if (source !== "edit") return;
    for (const frame of frames) {
      const slot = this._slots.get(frame);
      if (!slot) continue;
      slot.edits += 1;
      slot.refused = null;
      this._keep(frame, slot);
    }
    this._schedule(DELAY);
    this.emit("status");
  }

  _keep(frame, slot) {
    this._journal.write(frame, () => ({
      base: plain(slot.base),
      ours: plain(this._store.frame(frame)),
      sending: slot.sending && { saveId: slot.sending.saveId, body: slot.sending.body },
      edits: slot.edits,
      at: Date.now(),
    }));
  }

  /** The first edit starts the clock; later ones don't push it back. */
  _schedule(delay) {
    if (this._timer !== null && delay > 0) return;
    clearTimeout(this._timer);
    this._timer = setTimeout(() => {
      this._timer = null;
      for (const [frame, slot] of this._slots) if (slot.edits) this._send(frame);
    }, delay);
  }

  async _send(frame, options = {}) {
    const slot = this._slots.get(frame);
    if (slot.busy || slot.conflicts || slot.refused || this._readOnly !== null || slot.edits === 0) return;
    slot.sending ??= this._prepare(frame, slot);
    if (!slot.sending) return this.emit("status"); // undone before it was ever sent: all is saved again
    slot.busy = true;
    this._keep(frame, slot);
    try {
      const answer = await this._api.saveFrame(frame, slot.sending.body, options);
      this._acknowledge(frame, slot, answer);
    } catch (error) {
      this._fail(frame, slot, error);
    } finally {
      slot.busy = false;
      if (slot.edits && !this._trouble) this._schedule(DELAY);
      this.emit("status");
    }
  }

  _prepare(frame, slot) {
    const now = this._store.frame(frame);
    if (isSame(now, slot.base)) {
      slot.edits = 0;
      this._journal.clear(frame);
      return null;
    }
    const saveId = uuid4();
    const body = { save_id: saveId, revision: slot.base.revision, ...plain(now), seconds: this._activity.take(frame) };
    return { saveId, body, edits: slot.edits };
  }

  _acknowledge(frame, slot, answer) {
    this._trouble = null;
    this._retry = 0;
    slot.base = { revision: answer.revision, ...stateOf(slot.sending.body) };
    slot.edits -= slot.sending.edits;
    slot.sending = null;
    this._settle(frame, slot);
  }

  /** After an answer: nothing left to say, or more to send. */
  _settle(frame, slot) {
    if (isSame(this._store.frame(frame), slot.base)) {
      slot.edits = 0;
      this._journal.clear(frame);
    } else {
      slot.edits = Math.max(1, slot.edits);
      this._keep(frame, slot);
      this._schedule(DELAY);
    }
    this.emit("status");
  }

  _fail(frame, slot, error) {
    if (error instanceof ApiError && error.code === "stale") return this._merge(frame, slot, error.details.current);
    if (error instanceof ApiError && error.code === "read_only") return this.makeReadOnly(error.message);
    if (error instanceof ApiError && error.status === 400) return this._refuse(slot, error);
    if (error instanceof ApiError && error.status === 404) return this._refuse(slot, error);
    if (error instanceof ApiError && error.signedOut) this._trouble = "signed_out";
    else if (error instanceof NetworkError) this._trouble = "offline";
    else if (error instanceof ApiError) this._trouble = "server";
    else throw error;
    this._retry = Math.min(SLOWEST_RETRY, Math.max(1000, this._retry * 2));
    this._schedule(this._retry);
  }

  /** The server has a newer state: both sides' people come together, or the annotator is asked. */
  _merge(frame, slot, current) {
    const now = this._store.frame(frame);
    const theirs = baseOf(current);
    const { people, conflicts, renumber } = mergePeople(slot.base.people, now.people, theirs.people);
    const nobody = mergeFlag(slot.base.nobody, now.nobody, theirs.nobody) && people.size === 0;
    const finished = carriedOf(people).length === 0 && (people.size > 0 || nobody);
    const merged = { people, nobody, done: mergeFlag(slot.base.done, now.done, theirs.done) && finished };
    const renumbered = renumber.map((person) => now.people.get(person));
    slot.sending = null;
    slot.base = theirs;
    this._trouble = null;
    this._store.install(frame, merged, "server");
    this._store.apply(
      renumbered.map((one) => {
        const person = this._store.takePerson();
        return { frame, person, after: Object.freeze({ ...one, person }) };
      }),
    );
    if (conflicts.length) {
      slot.conflicts = conflicts;
      this.emit("conflict", { frame, conflicts });
    }
    this._settle(frame, slot);
  }

  _refuse(slot, error) {
    const places = Array.isArray(error.details) ? error.details.map(({ place, reason }) => `${place}: ${reason}`) : [];
    slot.refused = places.length ? places.join("; ") : error.message;
    slot.sending = null;
  }
}

function baseOf(state) {
  return { revision: state.revision, ...stateOf(state) };
}

/** From JSON: annotations as a map. */
function stateOf({ annotations, done, nobody }) {
  return { people: byPerson(annotations), done: Boolean(done), nobody: Boolean(nobody) };
}

/** To JSON. */
function plain({ people, done, nobody }) {
  return { annotations: asList(people), done, nobody };
}

function isSame(one, other) {
  return samePeople(one.people, other.people) && one.done === other.done && one.nobody === other.nobody;
}
