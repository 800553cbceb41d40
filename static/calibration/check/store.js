import { Emitter } from "../../base/emitter.js";
import { Camera } from "../../geometry/camera.js";
import { Draft } from "./draft.js";
import { figuresOf } from "./figures.js";

/**
 * @typedef {import("../../geometry/camera.js").CameraJSON} CameraJSON
 * @typedef {import("../saver.js").Saver} Saver
 * @typedef {import("./draft.js").Clicks} Clicks
 * @typedef {import("./figures.js").Figures} Figures
 * @typedef {"placed"|"in_place"} Against the desk's cameras, or its dataset's
 * @typedef {"test"|"correspondence"} Use
 * @typedef {{page: string, words: string}} Lack
 * @typedef {{name: string, width: number, height: number, light: string, full: string, placed: CameraJSON|null,
 *   in_place: CameraJSON|null, lacks: Lack|null}} CheckCamera
 * @typedef {{name: string, use: Use, clicks: Clicks}} KeptPoint
 * @typedef {{name: string, use: Use, clicks: {camera: string, x: number, y: number}[]}} KeptJSON
 * @typedef {{kept: KeptJSON[], undo: string, redo: string}} Kept
 * @typedef {Kept & {cameras: CheckCamera[]}} Checked
 * @typedef {{was: string, point: KeptJSON|null, undo: string, redo: string}} Answer
 * @typedef {{changed: null}} StoreEvents
 */

const FEWEST = 2; // clicks of a kept point

/**
 * Kept points, the thing that is being clicked, and under which cameras. What is done to a kept point goes to the
 * saver at once; a thing that is not kept yet is a draft.
 * @extends {Emitter<StoreEvents>}
 */
export class Store extends Emitter {
  /** @param {Checked} checked @param {Saver} saver */
  constructor(checked, saver) {
    super();
    this.all = checked.cameras;
    this._saver = saver;
    this.draft = new Draft();
    /** @type {string|null} the kept point that is looked at */
    this.selected = null;
    this.active = 0; // camera whose click is nudged
    /** @type {Clicks|null} what is being sent to be kept */
    this._sent = null;
    /** @type {WeakMap<Clicks, Figures>} */
    this._figures = new WeakMap();
    /** @type {Map<string, Camera>} those that are calibrated */
    this.cameras = new Map();
    /** @type {Against} */
    this.against = "placed";
    /** @type {KeptPoint[]} */
    this.kept = [];
    this.undo = "";
    this.redo = "";
    this._take(checked);
    const few = this.all.filter(({ placed }) => placed).length < 2;
    this.look(few && this.all.some(({ in_place: there }) => there) ? "in_place" : "placed");
    saver.on("answer", (answer) => this._answered(answer));
    saver.on("refused", () => this._refused());
  }

  /** @param {Against} against */
  look(against) {
    this.against = against;
    this._figures = new WeakMap();
    this.cameras = new Map();
    for (const camera of this.all) {
      const json = camera[against];
      if (json) this.cameras.set(camera.name, new Camera(json));
    }
    this.emit("changed", null);
  }

  /** @returns {KeptPoint|null} */
  get point() {
    return this.kept.find(({ name }) => name === this.selected) ?? null;
  }

  get clicks() {
    return this.point?.clicks ?? this.draft.clicks;
  }

  /** Of what is looked at. */
  get figures() {
    return this.figuresOf(this.clicks);
  }

  /** Computed once as long as neither clicks nor cameras change. @param {Clicks} clicks */
  figuresOf(clicks) {
    const known = this._figures.get(clicks) ?? figuresOf(clicks, this.cameras);
    this._figures.set(clicks, known);
    return known;
  }

  get steps() {
    const { undo, redo } = this.point ? { undo: "", redo: "" } : this.draft;
    return { undo: undo || this.undo, redo: redo || this.redo };
  }

  /** Take back or do again a step of the draft; false where the server has it. @param {"undo"|"redo"} what */
  step(what) {
    if (this.point || !this.draft[what]) return false;
    if (what === "undo") this.draft.takeBack();
    else this.draft.doAgain();
    this.emit("changed", null);
    return true;
  }

  /** All kept points anew. @param {Kept} kept */
  replace(kept) {
    const before = this.kept;
    this._take(kept);
    if (this.selected !== null && !this.point) this.selected = null;
    const gone = before.filter(({ name }) => !this.kept.some((each) => each.name === name));
    // Whoever undid keeping a point goes on with its clicks.
    if (gone.length === 1 && this.selected === null && this.draft.empty) this.draft.forget(gone[0].clicks);
    this.draft.forgetAhead();
    this.emit("changed", null);
  }

  /** Look at a kept point; what is being clicked waits. @param {string|null} name */
  select(name) {
    this.selected = name;
    this.emit("changed", null);
  }

  /** Another thing. */
  clear() {
    if (this.selected !== null) return this.select(null);
    this.draft.clear();
    this.emit("changed", null);
  }

  /** @param {number} index */
  activate(index) {
    this.active = index;
    this.emit("changed", null);
  }

  /** A click in a camera's picture. @param {number} index @param {number} x @param {number} y */
  click(index, x, y) {
    this.active = index;
    const { name } = this.all[index];
    if (this.cameras.has(name)) this._put(this.all[index], [x, y], `click in ${name}`);
    this.emit("changed", null);
  }

  /** @param {number} dx @param {number} dy pixels */
  nudge(dx, dy) {
    const camera = this.all[this.active];
    const click = this.clicks[camera?.name];
    if (click) this._put(camera, [click[0] + dx, click[1] + dy], `nudge in ${camera.name}`);
    this.emit("changed", null);
  }

  /** Take away the click in the view that is looked at, or else the last one. */
  takeBack() {
    const here = this.all[this.active]?.name;
    const camera = here in this.clicks ? here : Object.keys(this.clicks).at(-1);
    if (camera === undefined) return;
    const { point } = this;
    if (!point) this.draft.remove(camera);
    else {
      const { [camera]: _, ...clicks } = point.clicks;
      if (Object.keys(clicks).length >= FEWEST) this._change(point, { ...point, clicks });
      this._saver.send({ key: `${point.name} ${camera}`, method: "DELETE", path: clickPath(point.name, camera) });
    }
    this.emit("changed", null);
  }

  /** Keep the draft, or give the point that is looked at this use. @param {Use} use */
  keep(use) {
    if (this.point) return this._patch(this.point, { use });
    if (this._sent || Object.keys(this.draft.clicks).length === 0) return;
    const sent = this.draft.clicks;
    this._sent = sent;
    const clicks = Object.entries(sent).map(([camera, [x, y]]) => ({ camera, x, y }));
    this.draft.forget();
    this._saver.send({ key: "keep", method: "POST", path: "kept/", body: { use, clicks } });
    this.emit("changed", null);
  }

  /** @param {string} name */
  rename(name) {
    if (this.point && name && name !== this.point.name) this._patch(this.point, { name });
  }

  /** The point that is looked at. */
  remove() {
    const { point } = this;
    if (!point) return;
    this.kept = this.kept.filter((each) => each !== point);
    this.selected = null;
    this._saver.send({ key: point.name, method: "DELETE", path: pointPath(point.name) });
    this.emit("changed", null);
  }

  /** @param {CheckCamera} camera @param {number[]} place @param {string} what */
  _put({ name, width, height }, [x, y], what) {
    const place = [within(x, width), within(y, height)];
    const { point } = this;
    if (!point) return this.draft.put(name, place, what);
    this._change(point, { ...point, clicks: { ...point.clicks, [name]: place } });
    const body = { x: place[0], y: place[1] };
    this._saver.send({ key: `${point.name} ${name}`, method: "PUT", path: clickPath(point.name, name), body });
  }

  /** @param {KeptPoint} point @param {{name?: string, use?: Use}} body */
  _patch(point, body) {
    if (body.use) this._change(point, { ...point, use: body.use });
    this._saver.send({ key: point.name, method: "PATCH", path: pointPath(point.name), body });
    this.emit("changed", null);
  }

  /** @param {KeptPoint} before @param {KeptPoint} after */
  _change(before, after) {
    this.kept = this.kept.map((each) => (each === before ? after : each));
  }

  /** @param {Answer} answer */
  _answered({ was, point, undo, redo }) {
    this.undo = undo;
    this.redo = redo;
    if (!was) this._sent = null;
    // What waits to be sent is shown already and newer than the answer.
    if (this._saver.pending === 0 || !was || point?.name !== was) {
      const others = this.kept.filter(({ name }) => name !== was && name !== point?.name);
      this.kept = sorted(point ? [...others, fromJSON(point)] : others);
      if (was && point && this.selected === was) this.selected = point.name;
    }
    this.emit("changed", null);
  }

  _refused() {
    if (this._sent && this.draft.empty) this.draft.forget(this._sent);
    this._sent = null;
    this.emit("changed", null);
  }

  /** @param {Kept} kept */
  _take({ kept, undo, redo }) {
    this.kept = sorted(kept.map(fromJSON));
    this.undo = undo;
    this.redo = redo;
  }
}

/** @param {KeptJSON} json @returns {KeptPoint} */
function fromJSON({ name, use, clicks }) {
  return { name, use, clicks: Object.fromEntries(clicks.map(({ camera, x, y }) => [camera, [x, y]])) };
}

/** P2 before P10. @param {KeptPoint[]} points */
function sorted(points) {
  return points.sort((one, other) => one.name.localeCompare(other.name, "en", { numeric: true }));
}

/** @param {string} name */
function pointPath(name) {
  return `kept/named/${encodeURIComponent(name)}/`;
}

/** @param {string} name @param {string} camera */
function clickPath(name, camera) {
  return `${pointPath(name)}clicks/${encodeURIComponent(camera)}/`;
}

/** Half a thousandth of a pixel is finer than any hand. @param {number} value @param {number} size */
function within(value, size) {
  return Math.round(1000 * Math.min(Math.max(value, -0.5), size - 0.5)) / 1000;
}
