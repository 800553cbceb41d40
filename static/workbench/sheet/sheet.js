/**
 * Everybody of a frame side by side, close up: a click on the feet puts somebody there, a key refuses whoever is under
 * the pointer, and one key accepts all the rest. It lies over the views and goes along from frame to frame.
 * @typedef {import("../../base/answers.js").Proposed} Proposed
 * @typedef {import("../../truth/store.js").Store} Store
 * @typedef {import("./slots.js").Frame} Frame
 * @typedef {import("./slots.js").Shown} Shown
 * @typedef {import("./slots.js").Slot} Slot
 * @typedef {object} Proposals
 * @property {Proposed[]} open
 * @property {number} threshold
 * @property {(chosen: Proposed[]) => Map<Proposed, number>} personsOf
 * @property {(one: Proposed) => number|null} personOf
 * @property {(chosen: Proposed[], state: import("../../truth/annotation.js").State) =>
 *            import("../../truth/store.js").PersonEdit[]} edits
 * @property {(name: "change", listener: () => void) => unknown} on
 * @typedef {object} Parts
 * @property {import("../../truth/scene.js").Scene} scene
 * @property {Store} store
 * @property {import("../../views/images.js").Images} images
 * @property {import("../../views/panes.js").Panes} panes
 * @property {Proposals|null} proposals
 * @property {(id: string) => void} perform
 */
import { element, setText } from "../../base/dom.js";
import { gettext } from "../../base/messages.js";
import { paintSoon } from "../../base/repaint.js";
import { unit } from "../../base/scale.js";
import { keyFor } from "../keys/keys.js";
import { toolButton } from "../keys/tool_button.js";
import { SheetCell } from "./sheet_cell.js";
import { isOpen } from "./sheet_edits.js";
import { arrangeCells } from "./sheet_layout.js";
import { extended, shownOf, slotsOf } from "./slots.js";

const LINE = 20; // units: the line above a person's tiles

export class Sheet {
  /** @param {Parts} parts */
  constructor({ scene, store, images, panes, proposals, perform }) {
    this._scene = scene;
    this._store = store;
    this._images = images;
    this._panes = panes;
    this._proposals = proposals;
    /** @type {SheetCell[]} */
    this.cells = [];
    this._number = -1; // of the frame they are of
    this._stale = false; // they are of the frame before
    /** @type {SheetCell|null} the one that keys are about: under the pointer, or gone to */
    this.focus = null;
    /** @type {Set<SheetCell>} whoever has been in sight in this frame */
    this._seen = new Set();
    this._ahead = -1; // the frame whose pictures were asked for beforehand
    this._title = element("h2", {});
    this._count = element("p", { className: "sheet-count", role: "status" });
    this._hint = element("p", { className: "sheet-hint" });
    this._list = element("ol", { className: "sheet-cells", role: "listbox", "aria-label": gettext("People") });
    this._empty = element("p", { className: "sheet-empty", hidden: true });
    this.element = element(
      "section",
      { className: "sheet", "aria-label": gettext("Side by side"), hidden: true },
      element(
        "div",
        { className: "sheet-head" },
        this._title,
        this._count,
        this._hint,
        toolButton("validateNext", gettext("Accept the rest"), perform),
        toolButton("validateAll", gettext("Accept and go on"), perform),
        toolButton("sheet", gettext("Close"), perform),
      ),
      this._list,
      this._empty,
    );
    panes.element.append(this.element);
    this._follow();
  }

  get shown() {
    return !this.element.hidden;
  }

  /** @param {boolean} shown */
  show(shown) {
    this.element.hidden = !shown;
    if (shown && this._number !== this._store.current) this._begin();
    else if (shown)
      this.later(); // everybody has kept their places
    else this._panes.markPictures(); // what they need in full is theirs to say
  }

  _follow() {
    this._store.on("frame", () => this.shown && this._begin());
    this._store.on("change", () => this.later());
    this._store.on("selection", ({ after }) => this._goTo(after));
    this._proposals?.on("change", () => this.later());
    this._images.on("picture", () => this.later());
    this._list.addEventListener("scroll", () => this.later(), { passive: true });
    new ResizeObserver(() => this.later()).observe(this._list);
  }

  later() {
    if (this.shown) paintSoon(this);
  }

  /** Whoever is chosen elsewhere is gone to. @param {number|null} person */
  _goTo(person) {
    const cell = person === null ? undefined : this.cells.find(({ shown }) => shown?.person === person);
    if (this.shown && cell) this.focusOn(cell);
  }

  /** @returns {Frame} */
  _frame() {
    const proposals = this._proposals;
    const open = proposals?.open ?? [];
    const persons = proposals?.personsOf(open);
    return {
      people: this._store.people(),
      open,
      personOf: (one) => persons?.get(one) ?? proposals?.personOf(one) ?? null,
      doubtful: ({ score }) => score < (proposals?.threshold ?? 0),
    };
  }

  /** A frame is opened: its people get their places when all of them are there, those carried over, too. */
  _begin() {
    this._number = this._store.current;
    this._stale = true;
    this.focus = null;
    this._seen = new Set();
    this.later();
  }

  _arrive() {
    if (!this._stale) return;
    this._stale = false;
    this.cells = slotsOf(this._frame()).map((slot) => this._cell(slot));
    this._list.replaceChildren(...this.cells.map((cell) => cell.element));
    this._list.scrollTop = 0;
    this._update();
  }

  /** @param {Slot} slot */
  _cell(slot) {
    return new SheetCell(this._scene, this._images, slot);
  }

  _update() {
    const frame = this._frame();
    const known = this.cells.map(({ slot }) => slot);
    const added = extended(known, frame).slice(known.length);
    for (const cell of added.map((slot) => this._cell(slot))) {
      this.cells.push(cell);
      this._list.append(cell.element);
    }
    const shown = this.cells.map(({ slot }) => shownOf(slot, frame));
    const there = shown.filter(({ state }) => state !== "refused");
    this.cells.forEach((cell, index) => {
      const others = there.filter((one) => one !== shown[index]).map(({ placed }) => placed);
      cell.update(shown[index], others);
      cell.element.setAttribute("aria-selected", String(cell === this.focus));
    });
    this._tell(shown);
  }

  /** @param {Shown[]} shown */
  _tell(shown) {
    const { numbers, current } = this._store;
    const where = { place: numbers.indexOf(current) + 1, n: numbers.length };
    setText(this._title, gettext("Everybody of frame {place} of {n}", where));
    /** @param {import("./slots.js").SlotState} state */
    const count = (state) => shown.filter((one) => one.state === state).length;
    const counts = { open: count("open"), doubtful: count("doubtful"), accepted: count("accepted") };
    setText(this._count, gettext("{open} to accept, {doubtful} doubtful, {accepted} accepted", counts));
    const hint = gettext("Click on the feet to move a box · {key}: nobody there", { key: keyFor("remove") });
    setText(this._hint, shown.length ? hint : "");
    this._empty.hidden = shown.length > 0;
    const keys = { key: keyFor("sheet"), next: keyFor("nextFrame") };
    setText(
      this._empty,
      gettext(
        "Nobody is marked, carried over or proposed in this frame. {key} shows the views: click on the feet of whoever is there. {next} goes on.",
        keys,
      ),
    );
  }

  paint() {
    if (!this.shown) return;
    this._arrive();
    this._update();
    const size = { width: this._list.clientWidth / unit(), height: this._list.clientHeight / unit() };
    if (!size.width || !size.height) return;
    const arranged = arrangeCells(this.cells.length, size);
    this._list.style.setProperty("--columns", String(arranged.columns));
    const canvas = { width: arranged.width - 4, height: arranged.height - LINE - 4 };
    const bounds = this._list.getBoundingClientRect();
    let sharp = true;
    for (const cell of this.cells) {
      cell.resize(canvas);
      const { top, bottom } = cell.element.getBoundingClientRect();
      if (bottom <= bounds.top || top >= bounds.bottom) continue;
      if (top >= bounds.top - 2 && bottom <= bounds.bottom + 2) this._seen.add(cell);
      sharp = cell.paint(this._store.current) && sharp;
    }
    this.element.dataset.sharp = String(sharp);
    if (sharp) this._lookAhead();
  }

  /** Once everybody is sharp: the next frame's pictures in full, as far as there is room for them. */
  _lookAhead() {
    const next = this._store.neighbour(1);
    if (next === undefined || next === this._ahead) return;
    this._ahead = next;
    for (const view of new Set(this.cells.flatMap(({ anchors }) => anchors.map((one) => one.view))))
      this._images.get(next, view, "full");
  }

  /** Open ones who have been in sight, and whether some have not. */
  rest() {
    this._arrive();
    const open = this.cells.filter(({ shown }) => shown && isOpen(shown));
    const seen = open.filter((cell) => this._seen.has(cell));
    const shown = seen.flatMap((cell) => cell.shown ?? []);
    return { seen: shown, unseen: open.find((cell) => !this._seen.has(cell)) ?? null };
  }

  /** @param {SheetCell|null} cell */
  focusOn(cell) {
    if (cell === this.focus) return;
    this.focus = cell;
    for (const one of this.cells) one.element.setAttribute("aria-selected", String(one === cell));
    if (cell) this._list.setAttribute("aria-activedescendant", cell.element.id);
  }

  /** @param {SheetCell} cell */
  bring(cell) {
    cell.element.scrollIntoView({ block: "nearest" });
  }

  /** @param {EventTarget|null} target */
  cellAt(target) {
    const item = target instanceof Element ? target.closest("li") : null;
    return this.cells.find((cell) => cell.element === item) ?? null;
  }
}
