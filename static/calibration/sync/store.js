import { Emitter } from "../../base/emitter.js";
import {
  driftBy,
  extent,
  overlap,
  pictureNumber,
  pictureTime,
  setBy,
  sharedTime,
  toldFrom,
  videoTime,
} from "./clocks.js";

/**
 * @typedef {import("./clocks.js").Clock} Clock
 * @typedef {import("./clocks.js").Video} Video
 * @typedef {import("./clocks.js").Event} Event
 * @typedef {{file: string, camera: string, offset: number|null, confidence: string, alike: number}} Place
 * @typedef {{basis?: string, told?: string, places?: Place[]}} Guess
 * @typedef {{id: number, done: number, total: number, message: string}} UnderWay
 * @typedef {{id: number, source: string, revision: number, undo: boolean, redo: boolean, videos: Video[], clocks: Clock[],
 *   events: Event[], reference: string, guess: Guess, job: UnderWay|null, problem: string}} Draft
 * @typedef {{changed: null, moved: null}} StoreEvents `moved`: another instant, video or event is looked at
 */

/**
 * The draft, the instant that is looked at (`time`, seconds of the shared time), and which video and event. Every
 * change goes to the saver at once.
 * @extends {Emitter<StoreEvents>}
 */
export class Store extends Emitter {
  /** @param {Draft} draft @param {import("../saver.js").Saver} saver @param {import("./revised.js").Revised} revised */
  constructor(draft, saver, revised) {
    super();
    this.draft = draft;
    this._saver = saver;
    this._revised = revised;
    this._count = 0;
    this.index = 0;
    this.eventIndex = Math.max(draft.events.length - 1, 0);
    this.time = Math.max(this.shared.from, this.bounds.from);
    saver.on("answer", (answer) => this._take(answer));
  }

  get clocks() {
    return this.draft.clocks;
  }

  get clock() {
    return this.clocks[this.index];
  }

  /** @param {Clock} clock @returns {Video} */
  video(clock) {
    return /** @type {Video} */ (this.draft.videos.find(({ file }) => file === clock.file));
  }

  /** Index of a clock's video among the server's. @param {Clock} clock */
  number(clock) {
    return this.draft.videos.findIndex(({ file }) => file === clock.file);
  }

  get reference() {
    return this.clocks.find(({ file }) => file === this.draft.reference) ?? this.clocks[0];
  }

  get event() {
    return this.draft.events[this.eventIndex];
  }

  /** What the others' marks of the event are told from: the reference, else the first video that has a mark. */
  get markReference() {
    const { event, reference } = this;
    if (!event || event.marks[reference.file] !== undefined) return reference;
    return this.clocks.find(({ file }) => event.marks[file] !== undefined) ?? reference;
  }

  get used() {
    const used = this.clocks.filter((clock) => clock.used);
    return used.length ? used : this.clocks;
  }

  /** What all videos see. */
  get shared() {
    return overlap(this.used.map((clock) => ({ clock, video: this.video(clock) })));
  }

  /** From the first picture of any to the last of any. */
  get bounds() {
    const spans = this.used.map((clock) => extent(clock, this.video(clock)));
    return { from: Math.min(...spans.map(({ from }) => from)), until: Math.max(...spans.map(({ until }) => until)) };
  }

  /** @param {Draft} draft all of it, anew */
  replace(draft) {
    this.draft = draft;
    this._revised.revision = draft.revision;
    this.eventIndex = Math.min(this.eventIndex, Math.max(draft.events.length - 1, 0));
    this.emit("changed", null);
  }

  /** @param {number} time */
  goTo(time) {
    const { from, until } = this.bounds;
    this.time = Math.min(Math.max(time, from), until);
    this.emit("moved", null);
  }

  /** By so many pictures of the selected video. @param {number} count */
  step(count) {
    const video = this.video(this.clock);
    const number = pictureNumber(video, videoTime(this.clock, this.time)) + count;
    this.goTo(sharedTime(this.clock, pictureTime(video, number)));
  }

  /** @param {number} index */
  select(index) {
    if (!this.clocks[index]) return;
    this.index = index;
    this.emit("moved", null);
  }

  /** The next or previous video that is used. @param {1|-1} step */
  selectNext(step) {
    const count = this.clocks.length;
    for (let far = 1; far <= count; far += 1) {
      const index = (this.index + step * far + count * far) % count;
      if (this.clocks[index].used) return this.select(index);
    }
  }

  /** Move the selected video alone: what it shows now is that many seconds of it later. @param {number} seconds */
  shift(seconds) {
    this.setClock(this.index, { offset: Math.round(1e5 * (this.clock.offset + seconds)) / 1e5 });
  }

  /** @param {number} index @param {Partial<Clock>} values */
  setClock(index, values) {
    this._change({ clocks: this.clocks.map((clock, at) => (at === index ? { ...clock, ...values } : clock)) });
  }

  /** The selected video is what the others are told from. */
  refer() {
    const { clock, time } = this;
    const told = videoTime(clock, time);
    this._change({ clocks: toldFrom(this.clocks, clock), reference: clock.file });
    this.goTo(told);
  }

  addEvent() {
    const taken = new Set(this.draft.events.map(({ name }) => name));
    let number = this.draft.events.length + 1;
    while (taken.has(`Event ${number}`)) number += 1;
    this.eventIndex = this.draft.events.length;
    this._change({ events: [...this.draft.events, { name: `Event ${number}`, marks: {} }] });
  }

  /** @param {number} index */
  selectEvent(index) {
    if (!this.draft.events[index]) return;
    this.eventIndex = index;
    const times = this.clocks.flatMap((clock) => {
      const mark = this.event.marks[clock.file];
      return mark === undefined ? [] : [sharedTime(clock, mark)];
    });
    if (times.length) return this.goTo(times[0]);
    this.emit("moved", null);
  }

  /** @param {string} name */
  renameEvent(name) {
    if (this.event && name && name !== this.event.name) this._setEvent({ ...this.event, name });
  }

  removeEvent() {
    if (!this.event) return;
    const events = this.draft.events.filter((_, at) => at !== this.eventIndex);
    this.eventIndex = Math.max(this.eventIndex - 1, 0);
    this._change({ events });
  }

  /** The event happens in the selected video where it is now. @param {number} at second of the picture that is shown */
  mark(at) {
    const place = Math.round(1e6 * at) / 1e6;
    if (!this.event) return this._firstMark(place);
    this._setEvent({ ...this.event, marks: { ...this.event.marks, [this.clock.file]: place } });
  }

  /** @param {number} place */
  _firstMark(place) {
    this.eventIndex = 0;
    this._change({ events: [{ name: "Event 1", marks: { [this.clock.file]: place } }] });
  }

  unmark() {
    if (this.event?.marks[this.clock.file] === undefined) return;
    const marks = Object.fromEntries(Object.entries(this.event.marks).filter(([file]) => file !== this.clock.file));
    this._setEvent({ ...this.event, marks });
  }

  /** All videos in which the event is marked are put so that it is at one shared time. */
  setByEvent() {
    const { event, markReference } = this;
    if (event) this._change({ clocks: this.clocks.map((clock) => setBy(event, clock, markReference)) });
  }

  /** What the events say about drift, for each video that has two; by file. */
  get drifts() {
    const { reference } = this;
    const found = this.clocks.flatMap((clock) => {
      if (clock === reference) return [];
      const told = driftBy(this.draft.events, clock, reference, this.video(clock), this.video(reference));
      return told ? [/** @type {const} */ ([clock.file, told])] : [];
    });
    return new Map(found);
  }

  setDrifts() {
    const { drifts } = this;
    if (drifts.size) this._change({ clocks: this.clocks.map((clock) => drifts.get(clock.file)?.clock ?? clock) });
  }

  /** @param {"undo"|"redo"|"guess/take"} path */
  ask(path) {
    this._count += 1;
    this._saver.send({ key: `${path} ${this._count}`, method: "POST", path: `${path}/`, body: this._body({}) });
  }

  /** @param {Event} event */
  _setEvent(event) {
    this._change({ events: this.draft.events.map((each, at) => (at === this.eventIndex ? event : each)) });
  }

  /** @param {Partial<Draft>} values */
  _change(values) {
    this.draft = { ...this.draft, ...values, undo: true, redo: false };
    const { clocks, events, reference } = this.draft;
    // Every change is one of its own, so that undoing takes back one.
    this._count += 1;
    const body = this._body({ clocks, events, reference });
    this._saver.send({ key: `save ${this._count}`, method: "PUT", path: "", body });
    this.emit("changed", null);
  }

  /** @param {object} body */
  _body(body) {
    return { ...body, round: this._revised.round };
  }

  /** What the server has; not while later changes are on their way. @param {Draft} draft */
  _take(draft) {
    if (this._saver.pending === 0) this.replace(draft);
  }
}
