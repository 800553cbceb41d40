import { gettext } from "../../base/messages.js";
import { loadMissing } from "../../saving/load_missing.js";

/**
 * @typedef {"undo"|"redo"} Direction
 * @typedef {{nothing: () => string, done: (label: string) => string,
 *            there: (label: string, place: number) => string}} Words
 * @type {Record<Direction, Words>}
 */
const STEPS = {
  undo: {
    nothing: () => gettext("Nothing to undo"),
    done: (label) => gettext("Undone: {label}", { label }),
    there: (label, place) => gettext("Undone in frame {place}: {label}", { label, place }),
  },
  redo: {
    nothing: () => gettext("Nothing to redo"),
    done: (label) => gettext("Done again: {label}", { label }),
    there: (label, place) => gettext("Done again in frame {place}: {label}", { label, place }),
  },
};

/** Back and forth through everything that was done: goes to the frame it was done in, and says what it was. */
export class UndoActions {
  /**
   * @param {object} parts
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {import("../../truth/history.js").History} parts.history
   * @param {import("../../saving/loader.js").Loader} parts.loader
   * @param {import("../../base/notices.js").Notices} parts.notices
   * @param {import("../placing/guard.js").Guard} parts.guard
   */
  constructor({ store, history, loader, notices, guard }) {
    this.store = store;
    this.history = history;
    this.loader = loader;
    this.notices = notices;
    this.guard = guard;
    this._loading = false;
  }

  /**
   * Rows for the table of actions, by the ids of the key table.
   * @returns {import("../actions.js").ActionTable}
   */
  table() {
    return { undo: () => this.step("undo"), redo: () => this.step("redo") };
  }

  /**
   * Frames that a long layer has not loaded yet come first; otherwise it happens at once.
   * @param {Direction} direction
   */
  step(direction) {
    if (this._loading || this.guard.refused()) return;
    const missing = this.history.framesOf(direction).filter((number) => !this.store.frame(number).loaded);
    if (missing.length) this._loadThenStep(missing, direction);
    else this._step(direction);
  }

  /** @param {number[]} missing @param {Direction} direction */
  async _loadThenStep(missing, direction) {
    this._loading = true;
    try {
      if (await loadMissing(this, missing)) this._step(direction);
    } finally {
      this._loading = false;
    }
  }

  /** @param {Direction} direction */
  _step(direction) {
    const words = STEPS[direction];
    const here = this.store.current;
    const step = this.history[direction]();
    if (!step) return this.notices.say(words.nothing());
    const { label, frame } = step.patch;
    const said = frame === here ? words.done(label) : words.there(label, this.store.numbers.indexOf(frame) + 1);
    this.notices.say(step.skipped ? `${said} – ${gettext("except what was changed elsewhere since")}` : said);
  }
}
