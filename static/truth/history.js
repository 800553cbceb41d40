import { Emitter } from "../base/emitter.js";
import { annotation } from "./annotation.js";
import { combined, inverse } from "./commands.js";
import { same } from "./merge.js";

const LONGEST = 500; // steps kept
const TOGETHER = 900; // ms; presses of a held key are one step to undo

/**
 * Undo and redo over the store, across frames. Emits `change` after every step.
 * @typedef {import("./annotation.js").Annotation} Annotation
 * @typedef {import("./commands.js").Patch} Patch
 * @typedef {import("./store.js").Edit} Edit
 * @typedef {import("./store.js").FlagEdit} FlagEdit
 * @typedef {{done: Patch[], undone: Patch[]}} Stacks
 * @extends {Emitter<{change: void}>}
 */
export class History extends Emitter {
  /**
   * @param {import("./store.js").Store} store
   * @param {(patch: Patch) => Patch} complete adds what follows from an edit, so that both are one step
   */
  constructor(store, complete = (patch) => patch) {
    super();
    this._store = store;
    this._complete = complete;
    /** @type {Patch[]} */
    this._done = [];
    /** @type {Patch[]} */
    this._undone = [];
  }

  /**
   * What running a patch would really change: the patch with what follows from it.
   * @param {Patch} wanted
   */
  preview(wanted) {
    return this._complete(wanted);
  }

  /**
   * Frames the next undo (or redo) reaches into; they have to be loaded first.
   * @param {"undo"|"redo"} direction
   */
  framesOf(direction) {
    const patch = (direction === "undo" ? this._done : this._undone).at(-1);
    return patch ? [...new Set([patch.frame, ...patch.edits.map(({ frame }) => frame)])] : [];
  }

  /** @param {Patch} wanted */
  run(wanted) {
    const patch = this._complete(wanted);
    this._store.apply(patch.edits);
    if (patch.selection.after !== patch.selection.before) this._store.select(patch.selection.after);
    const last = this._done.at(-1);
    if (last && patch.group && last.group === patch.group && patch.at - last.at < TOGETHER) {
      this._done[this._done.length - 1] = combined(last, patch);
    } else {
      this._done.push(patch);
      if (this._done.length > LONGEST) this._done.shift();
    }
    this._undone = [];
    this.emit("change");
  }

  /** @returns {{patch: Patch, skipped: number} | null} null: nothing to undo */
  undo() {
    return this._step(this._done, this._undone, inverse);
  }

  redo() {
    return this._step(this._undone, this._done, (patch) => patch);
  }

  /**
   * Stacks as plain values, for keeping them over a reload.
   * @returns {Stacks}
   */
  dump() {
    return { done: this._done, undone: this._undone };
  }

  /** @param {Stacks} stacks */
  restore({ done, undone }) {
    /** @param {Patch} patch */
    const known = (patch) => patch.edits.every((edit) => this._store.frame(edit.frame));
    [this._done, this._undone] = [done.filter(known), undone.filter(known)];
    for (const { edits } of [...done, ...undone]) {
      for (const { person } of edits) if (person !== undefined) this._store.reservePerson(person);
    }
    this.emit("change");
  }

  /**
   * Somebody got another number for a reason outside the history: its steps mean the same person still.
   * @param {number} from @param {number} to @param {number[]} frames
   */
  renumber(from, to, frames) {
    /** @type {(one: Annotation|null|undefined) => Annotation|null} */
    const named = (one) => (one ? annotation({ ...one, person: to }) : null);
    /** @type {(edit: Edit) => Edit} */
    const renumbered = (edit) =>
      !edit.flags && edit.person === from && frames.includes(edit.frame)
        ? { ...edit, person: to, before: named(edit.before), after: named(edit.after) }
        : edit;
    /** @param {Patch} patch */
    const inside = (patch) => ({ ...patch, edits: patch.edits.map(renumbered) });
    [this._done, this._undone] = [this._done.map(inside), this._undone.map(inside)];
    this.emit("change");
  }

  /** @param {Patch[]} from @param {Patch[]} to @param {(patch: Patch) => Patch} direction */
  _step(from, to, direction) {
    const patch = from.pop();
    if (!patch) return null;
    const step = direction(patch);
    const edits = this._stillTrue(step.edits);
    to.push({ ...patch, group: null });
    this._store.open(step.frame);
    this._store.apply(edits);
    this._store.select(step.selection.after);
    this.emit("change");
    return { patch, skipped: step.edits.length - edits.length };
  }

  /**
   * Somebody else's newer change (merged in from a save) is not undone; then what was said about the whole frame
   * does not come back either.
   * @param {Edit[]} edits
   */
  _stillTrue(edits) {
    const found = edits.filter(
      (edit) => !edit.flags && same(this._store.person(edit.person, edit.frame) ?? null, edit.before),
    );
    /** @param {number} number */
    const complete = (number) => edits.every((edit) => edit.frame !== number || edit.flags || found.includes(edit));
    const flags = edits.filter((edit) => edit.flags && complete(edit.frame) && this._saysStill(edit));
    return [...found, ...flags];
  }

  /** @param {FlagEdit} edit */
  _saysStill({ frame, flags: { before } }) {
    const { done, nobody } = this._store.frame(frame);
    return done === before.done && nobody === before.nobody;
  }
}
