import { Fingers } from "./fingers.js";
import { contains } from "./regions.js";

const FOOT = 9; // CSS pixels around a foot point that mean the foot
const STILL = 4; // CSS pixels a pointer may wander during a click
const AGAIN = 6; // CSS pixels: a click here again means the person behind
const EDGE = 5; // CSS pixels around the top of the selected box that mean the top
const LONG = 550; // ms a finger stays in one place to mean "move here"
const TALL = 30; // CSS pixels a box must have for its top to be taken hold of

/**
 * @typedef {import("./intents.js").Part} Part
 * @typedef {import("./pane.js").Pane} Pane
 * @typedef {import("./pane.js").Person} Person
 * @typedef {import("./regions.js").XY} XY
 * @typedef {{person: Person, part: Part}} Grip
 * @typedef {{pane: Pane, at: XY, event: MouseEvent}} Under
 * @typedef {object} Press
 * @property {Pane} pane
 * @property {XY} at
 * @property {PointerEvent} last
 * @property {boolean} dragged
 * @property {Grip|null} grip
 * @property {boolean} holding somebody, not the picture
 */

/** Pointer events of the panes, as intents. Wheel and drags of the picture change a pane's pan and zoom directly. */
export class Pointer {
  /** @param {import("./panes.js").AnyPanes} panes @param {import("./intents.js").Intents} intents */
  constructor(panes, intents) {
    this._panes = panes;
    this._intents = intents;
    /** @type {Press|null} */
    this._press = null;
    this._fingers = new Fingers();
    /** @type {{pane: Pane, at: XY, person: number}|null} */
    this._lastPick = null;
    /** @type {MouseEvent|null} */
    this._over = null; // the mouse's last event over a pane
    /** @type {ReturnType<typeof setTimeout>|undefined} */
    this._longPress = undefined;
    for (const pane of panes.all) this._attach(pane);
  }

  /**
   * People under a point, best first: foot points, then boxes from the front to the back.
   * @param {Pane} pane @param {XY} at @returns {Person[]}
   */
  pick(pane, at) {
    if (!pane.transform) return [];
    const people = [...this._panes.store.people().values()];
    const feet = people
      .map((person) => ({ person, distance: footDistance(pane, person, at) }))
      .filter(({ distance }) => distance <= FOOT)
      .sort((one, other) => one.distance - other.distance)
      .map(({ person }) => person);
    const { x, y } = pane.transform.toSource(at.x, at.y);
    const inside = people
      .filter((person) => !feet.includes(person))
      .flatMap((person) => {
        const box = pane.view.box(person);
        return box && contains(box, x, y) ? [{ person, box }] : [];
      })
      .sort((one, other) => other.box.ymax - one.box.ymax)
      .map(({ person }) => person);
    return [...feet, ...inside];
  }

  /**
   * What a drag from here takes hold of, or null for the picture. The selected one comes first.
   * @param {Pane} pane @param {XY} at @returns {Grip|null}
   */
  grip(pane, at) {
    const selected = this._panes.store.selected();
    if (selected && onTop(pane, selected, at)) return { person: selected, part: "top" };
    const found = this.pick(pane, at);
    const person = found.find((one) => one === selected) ?? found[0];
    return person ? { person, part: "foot" } : null;
  }

  /**
   * Where the pointer is, or null when it is over none of the views.
   * @returns {Under|null}
   */
  under() {
    const event = this._over;
    const target = event && document.elementFromPoint(event.clientX, event.clientY);
    if (!event || !target || target.closest("button")) return null;
    const pane = this._panes.shown.find(({ element }) => element.contains(target));
    return pane?.transform ? { pane, at: pane.local(event), event } : null;
  }

  /** @param {Pane} pane */
  _attach(pane) {
    const { element } = pane;
    element.addEventListener("pointerenter", () => this._panes.activate(pane));
    element.addEventListener("pointerdown", (event) => this._onDown(pane, event));
    element.addEventListener("pointermove", (event) => this._onMove(pane, event));
    element.addEventListener("pointerup", (event) => this._onUp(pane, event));
    element.addEventListener("pointercancel", (event) => {
      this._fingers.up(event);
      this._forget(pane);
    });
    element.addEventListener("pointerleave", () => {
      this._over = null;
      this._intents.leave();
    });
    element.addEventListener("dblclick", (event) => onButton(event) || this._intents.enlarge(pane, event));
    element.addEventListener("contextmenu", (event) => this._onMenu(pane, event));
    element.addEventListener("wheel", (event) => this._onWheel(pane, event), { passive: false });
  }

  /** @param {Pane} pane @param {PointerEvent} event */
  _onDown(pane, event) {
    if (onButton(event) || !pane.transform) return;
    this._panes.activate(pane);
    this._over = event;
    clearTimeout(this._longPress);
    if (event.button === 2) return;
    if (this._fingers.down(pane, event)) return this._forget(pane); // a second finger: nothing is clicked, the picture is pinched
    this._press = {
      pane,
      at: pane.local(event),
      last: event,
      dragged: false,
      grip: this._gripOf(pane, event),
      holding: false,
    };
    pane.element.setPointerCapture(event.pointerId);
    if (event.pointerType === "touch") this._longPress = setTimeout(() => this._onLongPress(pane, event), LONG);
  }

  /**
   * A finger has no right button. Some systems say so themselves with a menu event, others don't: it is timed here.
   * @param {Pane} pane @param {PointerEvent} event
   */
  _onLongPress(pane, event) {
    if (!this._press || this._press.dragged) return;
    this._forget(pane);
    this._intents.moveHere(pane, pane.local(event), event);
  }

  /** @param {Pane} pane @param {PointerEvent} event */
  _onMove(pane, event) {
    this._over = event;
    if (this._fingers.move(pane, event)) return;
    const press = this._press;
    if (!press) return this._hover(pane, event);
    if (press.pane !== pane) return;
    const at = pane.local(event);
    if (!press.dragged && Math.hypot(at.x - press.at.x, at.y - press.at.y) > STILL) this._beginDrag(press);
    if (!press.dragged) return;
    if (press.holding) return this._intents.drag(at);
    const last = pane.local(press.last);
    if (pane.transform) pane.look(pane.transform.moved(at.x - last.x, at.y - last.y));
    press.last = event;
  }

  /** @param {Pane} pane @param {PointerEvent} event */
  _onUp(pane, event) {
    this._fingers.up(event);
    clearTimeout(this._longPress);
    const press = this._press;
    this._press = null;
    pane.element.classList.remove("dragging");
    if (press?.holding) return this._intents.drop();
    if (!press || press.pane !== pane || press.dragged || event.button !== 0) return;
    this._click(pane, event);
  }

  /**
   * Fingers pan: on glass nobody should be moved by accident. Shift and the other buttons mean the picture, too.
   * @param {Pane} pane @param {PointerEvent} event
   */
  _gripOf(pane, event) {
    if (
      event.button !== 0 ||
      event.pointerType === "touch" ||
      this._intents.pointsThrough ||
      event.shiftKey ||
      otherView(event)
    )
      return null;
    return this.grip(pane, pane.local(event));
  }

  /** @param {Press} press */
  _beginDrag(press) {
    const { pane, grip, last } = press;
    press.dragged = true;
    press.holding = grip !== null && this._intents.beginDrag(pane, pane.local(last), grip.person, grip.part, last);
    pane.element.classList.add("dragging");
  }

  /** @param {Pane} pane */
  _forget(pane) {
    clearTimeout(this._longPress);
    this._press = null;
    pane.element.classList.remove("dragging");
    this._intents.cancelDrag();
  }

  /** @param {Pane} pane @param {MouseEvent} event */
  _hover(pane, event) {
    if (!pane.transform) return;
    const at = pane.local(event);
    const grip = event.shiftKey || this._intents.pointsThrough ? null : this.grip(pane, at);
    pane.element.dataset.grip = (this._intents.takesHold && grip?.part) || "";
    this._intents.hover(pane, at, grip?.person ?? null);
  }

  /** @param {Pane} pane @param {MouseEvent} event */
  _click(pane, event) {
    const at = pane.local(event);
    if (otherView(event)) return this._intents.sight(pane, at, event);
    const found = event.shiftKey || this._intents.pointsThrough ? [] : this.pick(pane, at);
    if (!found.length) {
      this._lastPick = null;
      return this._intents.place(pane, at, event);
    }
    this._intents.select(this._inTurn(pane, at, found).person);
  }

  /**
   * Clicking on the same place again goes through everybody there.
   * @param {Pane} pane @param {XY} at @param {Person[]} found
   */
  _inTurn(pane, at, found) {
    const last = this._lastPick;
    const again = last?.pane === pane && Math.hypot(at.x - last.at.x, at.y - last.at.y) <= AGAIN;
    const index = again ? (found.findIndex(({ person }) => person === last.person) + 1) % found.length : 0;
    this._lastPick = { pane, at, person: found[index].person };
    return found[index];
  }

  /** @param {Pane} pane @param {PointerEvent} event */
  _onMenu(pane, event) {
    event.preventDefault();
    if (event.pointerType === "touch") return; // a long press, which is timed
    const controlClick = event.ctrlKey && event.button === 0; // how a Mac asks for a menu: it is a click of ours
    if (pane.transform && !controlClick && !onButton(event)) this._intents.moveHere(pane, pane.local(event), event);
  }

  /** @param {Pane} pane @param {WheelEvent} event */
  _onWheel(pane, event) {
    event.preventDefault();
    if (!pane.transform) return;
    const pixels = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? event.deltaY * 32 : event.deltaY;
    const { x, y } = pane.local(event);
    pane.look(pane.transform.zoomAt(Math.exp(-pixels / 400), x, y));
    this._hover(pane, event);
  }
}

/** @param {Pane} pane @param {Person} person @param {XY} at */
function footDistance(pane, person, at) {
  const foot = pane.view.box(person) && pane.view.foot(person);
  if (!foot || !pane.transform) return Infinity;
  const { x, y } = pane.transform.toPane(foot.x, foot.y);
  return Math.hypot(x - at.x, y - at.y);
}

/**
 * The key held that says: the same person, seen from here too. Some desktops keep Alt for themselves.
 * @param {MouseEvent} event
 */
function otherView(event) {
  return event.altKey || event.ctrlKey || event.metaKey;
}

/**
 * On the upper edge of a box in a camera's view, where the box is large enough to tell it from the rest.
 * @param {Pane} pane @param {Person} person @param {XY} at
 */
function onTop(pane, person, at) {
  const box = pane.view.index !== null && pane.view.box(person);
  if (!box || !pane.transform || (box.ymax - box.ymin) * pane.transform.scale < TALL) return false;
  const { x: left, y: top } = pane.transform.toPane(box.xmin, box.ymin);
  const { x: right } = pane.transform.toPane(box.xmax, box.ymin);
  return Math.abs(at.y - top) <= EDGE && at.x >= left - EDGE && at.x <= right + EDGE;
}

/** A pane's own button was meant. @param {MouseEvent} event */
function onButton({ target }) {
  return target instanceof Element && target.closest("button") !== null;
}
