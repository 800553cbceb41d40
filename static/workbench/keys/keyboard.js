import { chord, tellsForeign } from "../../base/key_press.js";
import { dialogArrives } from "../../base/lazy.js";
import { keyTable } from "./keys.js";

const FORM = "input, select, textarea, [contenteditable]";

/**
 * From keys to actions. While annotating, Tab and Space choose people; in control mode (F6) and inside dialogs
 * and fields they do what the browser does, so that nobody is trapped. Only keys that were used are stopped.
 */
export class Keyboard {
  /**
   * @param {(id: string, event: KeyboardEvent) => void} perform
   * @param {(controls: boolean) => void} onMode
   */
  constructor(perform, onMode) {
    this._perform = perform;
    this._onMode = onMode;
    this._actions = actionsByKey();
    this.controls = false;
    this._foreign = false; // whether the last letter was not a Latin one
    /** @param {KeyboardEvent} event */
    this._listener = (event) => this._onKey(event);
    document.addEventListener("keydown", this._listener);
  }

  /** Keys have been changed. */
  learn() {
    this._actions = actionsByKey();
  }

  /** @param {boolean} on */
  setControls(on) {
    this.controls = on;
    this._onMode(on);
  }

  remove() {
    document.removeEventListener("keydown", this._listener);
  }

  /** @param {KeyboardEvent} event */
  _onKey(event) {
    if (event.defaultPrevented || document.querySelector("dialog:modal")) return;
    if (event.target instanceof Element && event.target.closest(FORM)) return;
    this._foreign = tellsForeign(event) ?? this._foreign;
    const pressed = chord(event, this._foreign);
    const id = this._actions.get(pressed);
    if (!id || (this.controls && belongsToControls(pressed))) return;
    event.preventDefault();
    if (dialogArrives()) return;
    this._perform(id, event);
  }
}

/** @returns {Map<string, string>} ids by chords */
function actionsByKey() {
  return new Map(keyTable().flatMap(({ id, keys }) => keys.map((key) => [key, id])));
}

/** @param {string} pressed */
function belongsToControls(pressed) {
  return ["Tab", "Shift+Tab", " ", "Enter"].includes(pressed);
}
