import { element, setText } from "../../base/dom.js";
import { gettext, ngettext } from "../../base/messages.js";
import { paintSoon } from "../../base/repaint.js";
import { carriedOf } from "../../truth/annotation.js";
import { titleFor } from "../keys/keys.js";

/**
 * @typedef {import("../actions.js").Perform} Perform
 * @typedef {{node: HTMLElement, mark: HTMLElement, signature: string}} Cell
 */

/**
 * All frames in a line: what state each is in, play, and a scrubber to look through them. A frame's mark says it
 * by shape: ✓ done, a dashed ring yellow left, a dot worked on, nothing where nobody is yet; • not saved yet.
 */
export class Timeline {
  /**
   * @param {object} parts
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {import("../../saving/saver.js").Saver} parts.saver
   * @param {import("./navigation.js").Navigation} parts.navigation
   * @param {import("./playback.js").Playback} parts.playback
   * @param {Perform} parts.perform
   */
  constructor({ store, saver, navigation, playback, perform }) {
    this.store = store;
    this.saver = saver;
    this.navigation = navigation;
    this.playback = playback;
    /** @type {Map<number, Cell>} */
    this._cells = new Map();
    /** @type {Set<number>} */
    this._changed = new Set();
    /** @type {Set<number>} */
    this._unsaved = new Set();
    /** @type {number|null} */
    this._scrubbing = null; // the frame under the pointer
    this._play = this._button("play", "▶", perform);
    this._frames = this._line();
    this.element = this._build(perform);
    store.on("change", ({ frames }) => this._later(frames));
    store.on("frame", ({ before, after }) => this._later([before, after]));
    saver.on("status", () => this._later());
    playback.on("change", () => this._later());
    this._later(store.numbers);
    this.paint();
  }

  /** @param {Perform} perform */
  _build(perform) {
    this._play.setAttribute("aria-label", gettext("Play"));
    this._attach();
    return element(
      "section",
      { className: "timeline", "aria-label": gettext("Frames") },
      this._play,
      this._frames,
      this._button("filmstrip", gettext("Over time"), perform),
      this._button("nextTask", gettext("What is left"), perform),
    );
  }

  _line() {
    return element(
      "div",
      {
        className: "timeline-frames",
        role: "slider",
        tabIndex: 0,
        "aria-label": gettext("Frames"),
        "aria-valuemin": "1",
        "aria-valuemax": String(this.store.numbers.length),
      },
      this.store.numbers.map((number, index) => this._cell(number, index)),
    );
  }

  /** @param {string} id @param {string} text @param {Perform} perform */
  _button(id, text, perform) {
    /** @param {MouseEvent} event */
    const onclick = ({ detail, currentTarget }) => {
      perform(id);
      if (detail > 0 && currentTarget instanceof HTMLElement) currentTarget.blur(); // else Space would press it again
    };
    return element(
      "button",
      { type: "button", className: "quiet", "data-action": id, title: titleFor(id), onclick },
      text,
    );
  }

  /** @param {number} number @param {number} index */
  _cell(number, index) {
    const mark = element("span", { className: "mark" });
    const node = element(
      "span",
      { className: "timeline-frame", "data-number": String(number) },
      element("span", { className: "ordinal" }, String(index + 1)),
      mark,
    );
    this._cells.set(number, { node, mark, signature: "" });
    return node;
  }

  _attach() {
    const frames = this._frames;
    frames.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      event.preventDefault();
      frames.setPointerCapture(event.pointerId);
      this._scrub(event);
    });
    frames.addEventListener("pointermove", (event) => this._scrubbing !== null && this._scrub(event));
    frames.addEventListener("pointerup", () => this._land());
    frames.addEventListener("pointercancel", () => this._land());
    frames.addEventListener("keydown", (event) => this._onKey(event));
  }

  /**
   * While the pointer is down one only looks; where it is let go the frame is opened to work on.
   * @param {PointerEvent} event
   */
  _scrub(event) {
    const { left, width } = this._frames.getBoundingClientRect();
    const { numbers } = this.store;
    const index = Math.floor(((event.clientX - left) / width) * numbers.length);
    const number = numbers[Math.max(0, Math.min(numbers.length - 1, index))];
    if (number === this._scrubbing) return;
    this._scrubbing = number;
    this.navigation.look(number);
  }

  _land() {
    if (this._scrubbing === null) return;
    this.navigation.jump(this._scrubbing);
    this._scrubbing = null;
  }

  /**
   * As a slider with the keyboard's focus on it.
   * @param {KeyboardEvent} event
   */
  _onKey(event) {
    const { numbers } = this.store;
    const index = numbers.indexOf(this.store.current);
    /** @type {Record<string, number>} */
    const wanted = {
      ArrowLeft: index - 1,
      ArrowDown: index - 1,
      ArrowRight: index + 1,
      ArrowUp: index + 1,
      Home: 0,
      End: numbers.length - 1,
    };
    if (!(event.key in wanted)) return;
    event.preventDefault();
    const number = numbers[wanted[event.key]];
    if (number !== undefined) this.navigation.jump(number);
  }

  /**
   * Of a long layer only the cells of changed frames are looked at: this runs for every step of a held key.
   * @param {Iterable<number>} [frames]
   */
  _later(frames = []) {
    for (const number of frames) this._changed.add(number);
    paintSoon(this);
  }

  paint() {
    const { store, playback } = this;
    const unsaved = this.saver.unsavedFrames();
    for (const number of [...this._unsaved, ...unsaved]) this._changed.add(number);
    for (const number of this._changed) this._refresh(this._cells.get(number), number, unsaved.has(number));
    this._changed.clear();
    this._unsaved = unsaved;
    setText(this._play, playback.playing ? "❚❚" : "▶");
    this._play.setAttribute("aria-pressed", String(playback.playing));
    this._frames.setAttribute("aria-valuenow", String(store.numbers.indexOf(store.current) + 1));
    this._frames.setAttribute("aria-valuetext", this._words(store.current, unsaved.has(store.current)));
  }

  /** @param {Cell|undefined} cell @param {number} number @param {boolean} unsaved */
  _refresh(cell, number, unsaved) {
    const { state } = frameState(this.store.frame(number));
    const current = number === this.store.current;
    const words = this._words(number, unsaved);
    const signature = `${words} ${current}`;
    if (!cell || signature === cell.signature) return;
    cell.signature = signature;
    Object.assign(cell.node.dataset, { state, unsaved, current });
    cell.node.title = words;
    setText(cell.mark, state === "done" ? "✓" : "");
  }

  /** @param {number} number @param {boolean} unsaved */
  _words(number, unsaved) {
    const { state, people, yellow } = frameState(this.store.frame(number));
    const words = {
      done: gettext("done"),
      yellow: ngettext("{n} yellow", "{n} yellow", yellow),
      open: gettext("not done"),
      empty: gettext("nobody yet"),
      unknown: gettext("not loaded"),
    };
    return [
      gettext("Frame {place}", { place: this.store.numbers.indexOf(number) + 1 }),
      ...(people ? [ngettext("{n} person", "{n} people", people)] : []),
      words[state],
      ...(unsaved ? [gettext("not saved yet")] : []),
    ].join(", ");
  }
}

/** Pure. @param {import("../../truth/store.js").Frame} frame @returns {{state: "done"|"yellow"|"open"|"empty"|"unknown", people: number, yellow: number}} */
function frameState({ people, done, loaded }) {
  const yellow = carriedOf(people).length;
  const state = !loaded ? "unknown" : yellow ? "yellow" : done ? "done" : people.size ? "open" : "empty";
  return { state, people: people.size, yellow };
}
