import { ApiError } from "../base/api.js";
import { Emitter } from "../base/emitter.js";
import { uuid4 } from "../base/identifiers.js";
import { annotation, carriedOf } from "../truth/annotation.js";
import { mergeFlag, mergePeople } from "../truth/merge.js";
import { baseOf, isSame, plain, readRecord, recordOf, stateOf } from "./edit_record.js";
import { currentOf, refusalWords, saved, troubleOf } from "./save_failures.js";
import { statusOf } from "./save_status.js";

const DELAY = 700; // ms from an edit to its save
const FIRST_RETRY = 1000;
const SLOWEST_RETRY = 30_000;
const ROUNDS = 4; // of a flush: a save under way, what was edited meanwhile, and what was put together after it
const REFUSALS = [400, 404, 413]; // sending the same again would not help

/**
 * Saves whole frames. What has been sent is sent again, unchanged and under the same save id, until it is
 * answered: an answer lost on the way can then never look like somebody else's edit.
 *
 * Events: `status` (look at `status()`), `conflict` {frame, conflicts, author, savedAt} (or ask `conflicts()`),
 * `renumber` {from, to, frames}: a new person of ours got another number, because somebody else had taken it.
 *
 * @typedef {import("../base/answers.js").FrameAnswer} FrameAnswer
 * @typedef {import("../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../truth/store.js").Source} Source
 * @typedef {import("./edit_record.js").State} State
 * @typedef {import("./edit_record.js").Base} Base
 * @typedef {import("./edit_record.js").Question} Question
 * @typedef {import("./edit_record.js").Sending} Sending
 * @typedef {import("./edit_record.js").Slot} Slot
 * @typedef {import("./save_failures.js").SendOptions} SendOptions
 * @typedef {{from: number, to: number, frames: number[]}} Renumbered
 * @extends {Emitter<{status: void, conflict: Question, renumber: Renumbered}>}
 */
export class Saver extends Emitter {
  /**
   * @param {object} parts
   * @param {Pick<import("../base/api.js").Api, "saveFrame">} parts.api
   * @param {import("../truth/store.js").Store} parts.store
   * @param {Pick<import("./journal.js").Journal, "keeps"|"write"|"clear">} parts.journal
   * @param {import("./activity.js").Activity} parts.activity
   * @param {boolean} [parts.practice] in practice (the tutorial) nothing is saved
   */
  constructor({ api, store, journal, activity, practice = false }) {
    super();
    this._api = api;
    this._store = store;
    this._journal = journal;
    this._activity = activity;
    /** @type {Map<number, Slot>} */
    this._slots = new Map();
    /** @type {import("./save_failures.js").Trouble|null} */
    this._trouble = null;
    this._retry = 0;
    /** @type {ReturnType<typeof setTimeout>|null} */
    this._timer = null;
    /** @type {string|null} */
    this._readOnly = null;
    if (!practice) store.on("change", ({ frames, source }) => this._onChange(frames, source));
  }

  /** Take the server's state of a frame as the base of the next edits. @param {FrameAnswer} state */
  install(state) {
    const { number } = state;
    const added = this._slots.get(number)?.added ?? new Set();
    this._slots.set(number, {
      base: baseOf(state),
      sending: null,
      busy: null,
      edits: 0,
      added,
      question: null,
      refused: null,
    });
    this._store.install(number, baseOf(state), "server");
  }

  /**
   * The server's state of a frame that was asked for anew: what was edited or saved meanwhile stays.
   * @param {FrameAnswer} state
   */
  refresh(state) {
    const slot = this._slot(state.number);
    if (slot.edits === 0 && slot.base.revision <= state.revision) return this.install(state);
    // A save that has begun brings the newer state itself.
    if (slot.edits && !slot.sending && !slot.question && slot.base.revision < state.revision)
      this._merge(state.number, slot, state);
  }

  /**
   * Edits of an earlier visit that the server may not have: they go on from where they started.
   * @param {{frame: number} & import("./edit_record.js").StoredRecord} record
   */
  adopt(record) {
    const { frame } = record;
    const slot = this._slots.get(frame);
    if (!slot) return;
    const kept = readRecord(record);
    const untouched = slot.edits === 0;
    const { revision } = kept.base;
    if (untouched && revision !== undefined) this._goOn(frame, slot, { ...kept, base: { ...kept.base, revision } });
    else {
      const base = slot.base;
      if (untouched) this._store.install(frame, kept.ours, "journal");
      this._bringTogether(frame, slot, kept.base, untouched ? base : kept.ours, "journal");
    }
    for (const person of kept.added) slot.added.add(person);
    slot.edits += kept.edits;
    this._activity.giveBack(frame, kept.seconds);
    this._keep(frame, slot);
    this._schedule(0);
  }

  /** @param {number} frame @param {Slot} slot @param {import("./edit_record.js").Kept & {base: Base}} kept */
  _goOn(frame, slot, { base, ours, sending, question }) {
    Object.assign(slot, { base, sending, question });
    this._store.install(frame, ours, "journal");
  }

  /** @param {number} frame */
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

  /** @returns {import("./save_status.js").Status} */
  status() {
    const { unsaved, _trouble: trouble, _readOnly: readOnly } = this;
    return statusOf([...this._slots.values()], { unsaved, trouble, readOnly, kept: this._journal.keeps });
  }

  /** @param {number} frame one that was installed; TypeError otherwise */
  _slot(frame) {
    const slot = this._slots.get(frame);
    if (!slot) throw new TypeError(`frame ${frame} is not loaded`);
    return slot;
  }

  /** Why nothing may be changed, or null. */
  get readOnly() {
    return this._readOnly;
  }

  /** @param {string} reason */
  makeReadOnly(reason) {
    this._readOnly = reason;
    this.emit("status");
  }

  /** Save at once; resolves when everything that could be sent has been answered, also what was under way. */
  async flush() {
    clearTimeout(this._timer ?? undefined);
    this._timer = null;
    await this._underWay();
    for (let round = 0; round < ROUNDS && (round === 0 || this._canGoOn()); round += 1) {
      await Promise.all([...this._slots.keys()].map((frame) => this._send(frame)));
    }
    this.emit("status");
    return this.unsaved === 0;
  }

  async _underWay() {
    await Promise.all([...this._slots.values()].map(({ busy }) => busy));
  }

  _canGoOn() {
    return this._trouble === null && [...this._slots.values()].some((slot) => this._isToSend(slot));
  }

  /** The page goes away: the browser delivers these on its own; the journal has them too. */
  sendOnLeaving() {
    for (const [frame, slot] of this._slots) {
      if (!slot.busy) this._send(frame, { keepalive: true });
    }
  }

  /** Try again now: the network is back, or the annotator has signed in in another tab. */
  wake() {
    this._retry = 0;
    if (this.unsaved) this._schedule(0);
  }

  /** What the annotator has to decide, also from before a reload: {frame, conflicts, author, savedAt} each. */
  conflicts() {
    return [...this._slots.values()].flatMap(({ question }) => question ?? []);
  }

  /**
   * The annotator decided: per person, "ours" or "theirs".
   * @param {number} frame @param {Map<number, "ours"|"theirs">} choices
   */
  resolve(frame, choices) {
    const slot = this._slot(frame);
    if (!slot.question) throw new TypeError(`frame ${frame} has nothing to decide`);
    const edits = slot.question.conflicts
      .filter(({ person }) => choices.get(person) === "theirs")
      .map(({ person, theirs }) => ({ frame, person, after: theirs ?? null }));
    slot.question = null;
    this._store.apply(edits);
    this._settle(frame, slot);
  }

  /** @param {Set<number>} frames @param {Source} source */
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

  /** @param {number} frame @param {Slot} slot */
  _keep(frame, slot) {
    this._journal.write(frame, () => recordOf(slot, this._store.frame(frame), this._activity.waiting(frame)));
  }

  /** The first edit starts the clock; later ones don't push it back. @param {number} delay */
  _schedule(delay) {
    if (this._timer !== null && delay > 0) return;
    clearTimeout(this._timer ?? undefined);
    this._timer = setTimeout(() => {
      this._timer = null;
      for (const frame of this._slots.keys()) this._send(frame);
    }, delay);
  }

  /** @param {Slot} slot */
  _isToSend(slot) {
    return slot.edits > 0 && !slot.question && !slot.refused && this._readOnly === null;
  }

  /** @param {number} frame @param {SendOptions} [options] @returns {Promise<void>} when it has been answered; never rejects */
  _send(frame, options = {}) {
    const slot = this._slot(frame);
    if (slot.busy) return slot.busy;
    if (!this._isToSend(slot)) return Promise.resolve();
    slot.sending ??= this._prepare(frame, slot);
    if (!slot.sending) {
      this.emit("status"); // undone before it was ever sent: all is saved again
      return Promise.resolve();
    }
    this._keep(frame, slot);
    slot.busy = this._deliver(frame, slot, slot.sending, options);
    return slot.busy;
  }

  /** @param {number} frame @param {Slot} slot @param {Sending} sending @param {SendOptions} options */
  async _deliver(frame, slot, sending, options) {
    const retry = this._retry; // of all that are sent together, so that they make one step of waiting longer
    const asked = await saved(this._api, frame, sending.body, options);
    slot.busy = null;
    if ("error" in asked) this._fail(frame, slot, asked.error, retry);
    else this._acknowledge(frame, slot, sending, asked.answer);
    if (slot.edits && !this._trouble) this._schedule(DELAY);
    this.emit("status");
  }

  /** @param {number} frame @param {Slot} slot @returns {Sending|null} */
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

  /** @param {number} frame @param {Slot} slot @param {Sending} sending @param {FrameAnswer} answer */
  _acknowledge(frame, slot, sending, answer) {
    this._trouble = null;
    this._retry = 0;
    const base = { revision: answer.revision, ...stateOf(sending.body) };
    for (const person of base.people.keys()) if (!slot.base.people.has(person)) slot.added.add(person);
    slot.base = base;
    slot.edits -= sending.edits;
    slot.sending = null;
    this._settle(frame, slot);
  }

  /** After an answer: nothing left to say, or more to send. @param {number} frame @param {Slot} slot */
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

  /** @param {number} frame @param {Slot} slot @param {unknown} error @param {number} retry @returns {void} */
  _fail(frame, slot, error, retry) {
    const known = error instanceof ApiError && error.code !== "unknown";
    if (known && error.code === "stale") return this._merge(frame, slot, currentOf(error));
    if (known && error.code === "read_only") return this.makeReadOnly(error.message);
    if (known && REFUSALS.includes(error.status)) return this._refuse(frame, slot, error);
    if (known && error.code === "save_id_used") this._takeBack(frame, slot); // the next try has an id of its own
    this._trouble = troubleOf(error);
    this._retry = Math.min(SLOWEST_RETRY, Math.max(FIRST_RETRY, retry * 2));
    this._schedule(this._retry);
  }

  /** What was sent was not written, for certain. @param {number} frame @param {Slot} slot */
  _takeBack(frame, slot) {
    if (slot.sending) this._activity.giveBack(frame, slot.sending.body.seconds);
    slot.sending = null;
  }

  /**
   * The server has a newer state: both sides' people come together, or the annotator is asked.
   * @param {number} frame @param {Slot} slot @param {FrameAnswer} current
   */
  _merge(frame, slot, current) {
    const theirs = baseOf(current);
    const { base } = slot;
    this._takeBack(frame, slot);
    slot.base = theirs;
    this._trouble = null;
    this._bringTogether(frame, slot, base, theirs, "server", { author: current.author, savedAt: current.saved_at });
    this._settle(frame, slot);
  }

  /**
   * The frame as the store has it, and `theirs`, which both come from `base`.
   * @param {number} frame @param {Slot} slot @param {State} base @param {State} theirs @param {Source} source
   * @param {{author?: string, savedAt?: string|null}} [who]
   */
  _bringTogether(frame, slot, base, theirs, source, { author = "", savedAt = null } = {}) {
    const now = this._store.frame(frame);
    const ours = now.people;
    const { people, conflicts, renumber } = mergePeople(base.people, ours, theirs.people);
    const nobody = mergeFlag(base.nobody, now.nobody, theirs.nobody) && people.size === 0;
    const finished = carriedOf(people).length === 0 && (people.size > 0 || nobody);
    this._store.install(
      frame,
      { people, nobody, done: mergeFlag(base.done, now.done, theirs.done) && finished },
      source,
    );
    for (const one of renumber.flatMap((person) => ours.get(person) ?? [])) this._renumber(frame, one);
    if (!conflicts.length) return;
    slot.question = { frame, conflicts, author, savedAt };
    this.emit("conflict", slot.question);
  }

  /**
   * Somebody else gave away the same number: our new person gets another one, wherever we have put it.
   * @param {number} frame @param {Annotation} one
   */
  _renumber(frame, one) {
    const { person: from } = one;
    const to = this._store.takePerson();
    const others = [...this._slots]
      .filter(([number, slot]) => number !== frame && this._isOurs(slot, number, from))
      .map(([number]) => number);
    /** @type {(number: number, old: Annotation) => import("../truth/store.js").PersonEdit} */
    const moved = (number, old) => ({ frame: number, person: to, after: annotation({ ...old, person: to }) });
    this._store.apply([
      moved(frame, one),
      ...others.flatMap((number) => [
        { frame: number, person: from, after: null },
        moved(number, this._store.marked(from, number)),
      ]),
    ]);
    this.emit("renumber", { from, to, frames: [frame, ...others] });
  }

  /** @param {Slot} slot @param {number} frame @param {number} person */
  _isOurs(slot, frame, person) {
    return this._store.person(person, frame) !== undefined && (slot.added.has(person) || !slot.base.people.has(person));
  }

  /** @param {number} frame @param {Slot} slot @param {ApiError} error */
  _refuse(frame, slot, error) {
    slot.refused = refusalWords(error);
    this._takeBack(frame, slot);
    this._keep(frame, slot);
  }
}
