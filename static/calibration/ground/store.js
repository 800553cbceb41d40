import { Emitter } from "../../base/emitter.js";

/**
 * @typedef {{name: string, x: number, y: number, z: number}} Point metres
 * @typedef {{name: string, x: number, y: number, sigma: number}} Ghost pixels
 * @typedef {{name: string, dx: number|null, dy: number|null, px: number|null, cm: number|null, used: boolean}} Residual
 * @typedef {{trouble: string, text: string, names: string[]}} Finding
 * @typedef {{problem: string, rms?: number, centre?: number[], centre_sigma?: (number|null)[], residuals?: Residual[],
 *   findings?: Finding[], ghosts?: Ghost[]}} Report
 * @typedef {{name: string, width: number, height: number, light: string, full: string, lens: string,
 *   clicks: {[point: string]: number[]}, placed: import("../../geometry/camera.js").CameraJSON|null, report: Report}} DeskCamera
 * @typedef {{points: Point[], doubts: string[], cameras: DeskCamera[], undo: string, redo: string}} Ground
 * @typedef {{changed: null, moved: null}} StoreEvents `moved`: another camera or point is looked at
 * @typedef {import("../saver.js").Saver} Saver
 */

const REACH = 40; // CSS pixels: a click so near an expected point means that one

/**
 * Points, cameras and clicks, and which of them is being looked at. What is done goes to the saver at once; the
 * server's answer brings the pose.
 * @extends {Emitter<StoreEvents>}
 */
export class Store extends Emitter {
  /** @param {Ground} ground @param {Saver} saver */
  constructor(ground, saver) {
    super();
    this.ground = ground;
    this._saver = saver;
    this.index = 0;
    /** @type {string|null} */
    this.selected = null;
    /** @type {Map<string, number[]>} pixels by which an expected point was nudged before it is confirmed */
    this._nudges = new Map();
    saver.on("answer", (answer) => this._take(answer));
    this.selectNext();
  }

  get camera() {
    return this.ground.cameras[this.index];
  }

  /** @param {Ground} ground all of it, anew */
  replace(ground) {
    this.ground = ground;
    this._nudges.clear();
    if (!ground.points.some(({ name }) => name === this.selected)) this.selected = null;
    this.emit("changed", null);
  }

  /** @param {number} index */
  selectCamera(index) {
    if (!this.ground.cameras[index] || index === this.index) return;
    this.index = index;
    this._nudges.clear();
    this.selectNext();
  }

  /** @param {string} name */
  select(name) {
    this.selected = name;
    this.emit("moved", null);
  }

  /** The next point that is expected in the picture and not clicked; without a pose, the next in the list. @param {1|-1} [step] */
  selectNext(step = 1) {
    const names = this.ground.points.map(({ name }) => name);
    const open = names.filter((name) => !this.clickOf(name) && (!this.camera?.placed || this.ghostOf(name)));
    const from = this.selected === null ? -1 : names.indexOf(this.selected);
    const ordered = step === 1 ? open : open.reverse();
    const next = ordered.find((name) => (names.indexOf(name) - from) * step > 0) ?? ordered[0];
    this.selected = next ?? this.selected ?? names[0] ?? null;
    this.emit("moved", null);
  }

  /** @param {string} name @returns {number[]|null} */
  clickOf(name) {
    if (!this.camera) return null;
    const waiting = this._saver.waiting(this._key(name));
    if (waiting) return /** @type {{x: number, y: number}|undefined} */ (waiting.body) ? placeOf(waiting.body) : null;
    return this.camera.clicks[name] ?? null;
  }

  /** Where a point is expected, nudges included. @param {string} name @returns {Ghost|null} */
  ghostOf(name) {
    const found = this.camera?.report.ghosts?.find((ghost) => ghost.name === name);
    if (!found) return null;
    const [dx, dy] = this._nudges.get(name) ?? [0, 0];
    return { ...found, x: found.x + dx, y: found.y + dy };
  }

  /** Expected and not clicked yet. */
  get ghosts() {
    const found = this.camera?.report.ghosts ?? [];
    return found.flatMap(({ name }) => (this.clickOf(name) ? [] : (this.ghostOf(name) ?? [])));
  }

  /** Where the selected point is: clicked or expected. */
  get place() {
    if (this.selected === null) return null;
    const click = this.clickOf(this.selected);
    if (click) return { x: click[0], y: click[1] };
    return this.ghostOf(this.selected);
  }

  /**
   * A click in the picture: an expected point nearby is meant, else the selected one.
   * @param {number} x @param {number} y @param {number} unit pixels of the picture that are one CSS pixel
   */
  click(x, y, unit) {
    const distance = (/** @type {Ghost} */ ghost) => Math.hypot(ghost.x - x, ghost.y - y);
    const near = this.ghosts
      .filter((ghost) => distance(ghost) <= REACH * unit)
      .sort((a, b) => distance(a) - distance(b));
    const name = near[0]?.name ?? this.selected;
    if (name === null) return;
    this.selected = name;
    this._put(name, x, y);
    this.selectNext();
  }

  /** The selected point is where it is expected, or where it was nudged to. */
  confirm() {
    const name = this.selected;
    const ghost = name !== null && !this.clickOf(name) ? this.ghostOf(name) : null;
    if (name !== null && ghost) this._put(name, ghost.x, ghost.y);
    this.selectNext();
  }

  /** @param {number} dx @param {number} dy pixels */
  nudge(dx, dy) {
    const name = this.selected;
    if (name === null) return;
    const click = this.clickOf(name);
    if (click) return this._put(name, click[0] + dx, click[1] + dy);
    if (!this.ghostOf(name)) return;
    const [x, y] = this._nudges.get(name) ?? [0, 0];
    this._nudges.set(name, [x + dx, y + dy]);
    this.emit("changed", null);
  }

  /** Take the selected point's click away. */
  remove() {
    const name = this.selected;
    if (name === null || !this.clickOf(name)) return;
    this._saver.send({ key: this._key(name), method: "DELETE", path: this._path(name) });
    this.emit("changed", null);
  }

  /** @param {string} name @param {number} x @param {number} y */
  _put(name, x, y) {
    const { width, height } = this.camera;
    const body = { x: within(x, width), y: within(y, height) };
    this._nudges.delete(name);
    this._saver.send({ key: this._key(name), method: "PUT", path: this._path(name), body });
    this.emit("changed", null);
  }

  /** @param {{camera?: DeskCamera, undo: string, redo: string}} answer */
  _take(answer) {
    const { camera, undo, redo } = answer;
    if (!camera) return;
    const cameras = this.ground.cameras.map((each) => (each.name === camera.name ? camera : each));
    const placed = this.camera.name === camera.name && !this.camera.placed && camera.placed;
    this.ground = { ...this.ground, cameras, undo, redo };
    if (placed && this.selected !== null && !this.ghostOf(this.selected)) this.selectNext();
    this.emit("changed", null);
  }

  /** @param {string} name */
  _key(name) {
    return `${this.camera.name} ${name}`;
  }

  /** @param {string} name */
  _path(name) {
    return `cameras/${encodeURIComponent(this.camera.name)}/clicks/${encodeURIComponent(name)}/`;
  }
}

/** @param {object|undefined} body */
function placeOf(body) {
  const { x, y } = /** @type {{x: number, y: number}} */ (body);
  return [x, y];
}

/** Half a thousandth of a pixel is finer than any hand. @param {number} value @param {number} size */
function within(value, size) {
  return Math.round(1000 * Math.min(Math.max(value, -0.5), size - 0.5)) / 1000;
}
