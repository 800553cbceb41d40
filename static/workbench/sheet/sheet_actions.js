/**
 * Keys and the pointer at the sheet.
 * @typedef {import("./sheet.js").Sheet} Sheet
 * @typedef {import("./sheet_cell.js").SheetCell} SheetCell
 * @typedef {import("./sheet_edits.js").Proposing} Proposing
 * @typedef {() => unknown} Otherwise what a key does while the sheet is closed
 * @typedef {(otherwise: Otherwise, event: KeyboardEvent|null) => unknown} Row
 * @typedef {object} Parts
 * @property {Sheet} sheet
 * @property {import("../../truth/scene.js").Scene} scene
 * @property {import("../../truth/store.js").Store} store
 * @property {import("../../truth/history.js").History} history
 * @property {import("../../views/panes.js").Panes} panes
 * @property {import("../../base/notices.js").Notices} notices
 * @property {{refused: () => boolean}} guard
 * @property {Proposing|null} proposals
 * @property {{settle: (person: number) => unknown}|null} snapping
 * @property {{next: () => Promise<unknown>}} navigation
 */
import { gettext, ngettext } from "../../base/messages.js";
import { freePosition } from "../../truth/propagation.js";
import { keyFor } from "../keys/keys.js";
import { footFrom } from "./fused_foot.js";
import { acceptAll, isOpen, putAt, refuse } from "./sheet_edits.js";

const HAND = 2; // CSS pixels a click may be off along each axis
const SHOE = 1; // pixels of the picture that a shoe's edge leaves open
const [PROPOSED, GUESSED] = [0.1, 0.2]; // metres that somebody may be off who was proposed, and who was not
const FAR = 10; // positions a step with Shift goes

/** @typedef {"left"|"right"|"up"|"down"} Direction */

export class SheetActions {
  /** @param {Parts} parts */
  constructor({ sheet, scene, store, history, panes, notices, guard, proposals, snapping, navigation }) {
    this._sheet = sheet;
    this._scene = scene;
    this._store = store;
    this._history = history;
    this._panes = panes;
    this._notices = notices;
    this._guard = guard;
    this._proposals = proposals;
    this._snapping = snapping;
    this._navigation = navigation;
    /** @type {PointerEvent|null} where the pointer is over somebody */
    this._last = null;
    const { element } = sheet;
    element.addEventListener("pointermove", (event) => this._hover(event));
    element.addEventListener("click", (event) => this._click(event));
    element.addEventListener("contextmenu", (event) => this._click(event));
    element.addEventListener("dblclick", (event) => event.stopPropagation());
  }

  /** Rows around those of the table of actions: while the sheet is open they are about its people. */
  table() {
    /** @type {Record<string, Row>} */
    const rows = {
      validateNext: this._here((event) => event?.repeat || this._acceptRest()), // a key held down looks at nobody
      validateAll: this._here((event) => event?.repeat || this._acceptAndGoOn()),
      validate: this._here(() => this._withOne((cell) => this._acceptOne(cell))),
      remove: this._here(() => this._withOne((cell) => this._refuse(cell))),
      nextPerson: this._here(() => this._step(1)),
      previousPerson: this._here(() => this._step(-1)),
      moveHere: this._here(() => this._last && this._click(this._last)),
      escape: this._here(() => this.toggle()),
    };
    for (const id of ["round", "largeView", "zoom"]) rows[id] = (otherwise) => this._close(otherwise);
    for (const name of /** @type {Direction[]} */ (["left", "right", "up", "down"])) {
      rows[name] = this._here(() => this._withOne((cell) => this._push(cell, name, 1)));
      rows[`${name}Far`] = this._here(() => this._withOne((cell) => this._push(cell, name, FAR)));
    }
    return rows;
  }

  /** What is about the views shows them. @param {Otherwise} otherwise */
  _close(otherwise) {
    if (this._sheet.shown) this.toggle();
    otherwise();
  }

  toggle() {
    this._sheet.show(!this._sheet.shown);
  }

  /** @param {(event: KeyboardEvent|null) => unknown} act @returns {Row} */
  _here(act) {
    return (otherwise, event) => (this._sheet.shown ? act(event) : otherwise());
  }

  /** @returns {boolean} whether everybody is accepted or refused now */
  _accept() {
    const { seen, unseen } = this._sheet.rest();
    if (seen.length) {
      this._history.run(acceptAll(this._store, this._proposals, seen));
      this._notices.say(ngettext("{n} person accepted", "{n} people accepted", seen.length));
    }
    if (!unseen) return true;
    this._sheet.bring(unseen);
    const words = { key: keyFor("validateNext") };
    this._notices.say(gettext("Some have not been in sight yet: look at them, and press {key} again", words));
    return false;
  }

  /** When nobody is left, the same key goes on. */
  _acceptRest() {
    if (this._guard.refused()) return;
    const { seen, unseen } = this._sheet.rest();
    if (!seen.length && !unseen) return this._navigation.next();
    this._accept();
  }

  _acceptAndGoOn() {
    if (!this._guard.refused() && this._accept()) this._navigation.next();
  }

  /** @param {SheetCell} cell */
  _acceptOne({ shown }) {
    if (shown && isOpen(shown)) this._history.run(acceptAll(this._store, this._proposals, [shown]));
  }

  /** Who is refused already stays so. @param {SheetCell} cell */
  _refuse({ shown }) {
    const words = { key: keyFor("undo") };
    if (!shown || shown.state === "refused")
      return this._notices.say(gettext("Nobody is there already – {key} takes it back", words));
    this._history.run(refuse(this._store, shown));
    this._notices.say(gettext("Nobody there – {key} takes it back", words));
  }

  /** @param {(cell: SheetCell) => void} act on the one under the pointer, or gone to */
  _withOne(act) {
    const cell = this._sheet.focus;
    if (this._guard.refused()) return;
    if (cell) return act(cell);
    this._notices.say(gettext("Point at somebody, or go to the next one: {key}", { key: keyFor("nextPerson") }));
  }

  /** @param {1|-1} offset */
  _step(offset) {
    const { cells, focus } = this._sheet;
    if (!cells.length) return;
    const index = focus ? cells.indexOf(focus) + offset : offset > 0 ? 0 : -1;
    const cell = cells[(index + cells.length) % cells.length];
    this._sheet.focusOn(cell);
    this._sheet.bring(cell);
    const person = cell.shown?.person ?? null;
    if (person !== null && this._store.person(person)) this._store.select(person);
  }

  /** As the person's first tile shows it. @param {SheetCell} cell @param {Direction} name @param {number} far */
  _push({ shown, anchors }, name, far) {
    const pane = this._panes.all.find(({ view }) => view.index === anchors[0]?.view);
    const axes = shown && pane?.view.axes(shown.placed);
    if (!shown || !axes) return;
    for (let cells = far; ; cells += 1) {
      const { columns, rows } = axes[name];
      const position = this._scene.stepped(shown.placed.position, columns * cells, rows * cells);
      if (position === null) return this._notices.say(gettext("The ground area ends here"));
      if (this._store.occupant(position, shown.person)) continue;
      return this._history.run(putAt(this._store, this._proposals, shown, position));
    }
  }

  /** @param {PointerEvent} event */
  _hover(event) {
    const cell = this._sheet.cellAt(event.target);
    this._last = cell && event;
    if (cell) this._sheet.focusOn(cell);
  }

  /** @param {MouseEvent} event */
  _click(event) {
    const cell = this._sheet.cellAt(event.target);
    if (!cell) return;
    event.preventDefault();
    this._sheet.focusOn(cell);
    const hit = cell.hit(event);
    const place = { x: event.clientX, y: event.clientY };
    if (!hit || !cell.shown || this._guard.refused()) return;
    const known = cell.known ?? { ...this._scene.metres(cell.shown.placed.position), sigma: doubtOf(cell) };
    const click = { view: hit.view, pixel: hit.pixel, sigma: Math.hypot(SHOE, HAND / hit.scale) };
    const clicks = [...cell.clicks.filter(({ view }) => view !== hit.view), click];
    const ground = footFrom(this._scene, known, clicks);
    if (!ground || this._scene.positionAt(ground) === null)
      return this._notices.sayAt(place, gettext("Outside the ground area"));
    this._put(cell, ground);
    Object.assign(cell, { known, clicks });
    if (!cell.slot.proposal && cell.shown.person !== null) this._snapping?.settle(cell.shown.person);
  }

  /** @param {SheetCell} cell @param {{x: number, y: number}} ground */
  _put(cell, ground) {
    const { shown } = cell;
    if (!shown) return;
    const others = [...this._store.people().values()].filter(({ person }) => person !== shown.person);
    const position = freePosition(this._scene.grid, ground, new Set(others.map((one) => one.position)));
    cell.put = position; // before the store says so: clicks that have led there go on to count
    this._history.run(putAt(this._store, this._proposals, shown, position));
  }
}

/** @param {SheetCell} cell */
function doubtOf({ slot, shown }) {
  return slot.proposal && slot.proposal.position === shown?.placed.position ? PROPOSED : GUESSED;
}
