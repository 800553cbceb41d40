import { element, setText } from "../base/dom.js";
import { gettext } from "../base/messages.js";
import { paintSoon } from "../base/repaint.js";
import { unit } from "../base/scale.js";
import { contextOf } from "./marks.js";
import { damage, overlaps } from "./regions.js";
import { lookOf } from "./styles.js";
import { clamped, fit, resized } from "./transform.js";

/**
 * One view on the screen: a canvas with the picture and a canvas with the marks. It paints what the model says
 * through its transform and never changes the model. Only the damaged part of the marks is painted again.
 * @typedef {import("./regions.js").XY} XY
 * @typedef {import("./regions.js").Size} Size
 * @typedef {import("./regions.js").Rectangle} Rectangle
 * @typedef {import("./regions.js").Item} Item
 * @typedef {import("./styles.js").Look} Look
 * @typedef {import("./display.js").Options} Options
 * @typedef {import("./transform.js").Transform} Transform
 * @typedef {import("../geometry/directions.js").Step} Step
 * @typedef {{position: number, height: number|null, radius: number|null}} Placed what a view draws: a cylinder somewhere
 * @typedef {Placed & {person: number, state?: import("../truth/annotation.js").State}} Person an annotation, or the
 *   side of a mark of a comparison
 * @typedef {Item & {order: number}} PersonItem those with a larger order are drawn later
 * @typedef {{status: "waiting"|"loading"|"ready"|"error", error: string}} PictureState
 * @typedef {Record<"left"|"right"|"up"|"down", Step>} Axes what each arrow key does
 *
 * @typedef {object} View what a pane shows: a camera's pictures, or the map; a place in it is in source pixels or metres
 * @property {string} id
 * @property {number|null} index of the camera; null: the map
 * @property {string} title
 * @property {boolean} byTable whether it is of a camera model that this page does not know
 * @property {Size} size
 * @property {number} largest scale
 * @property {(point: XY, z?: number) => XY|null} ground what a place shows at a height, in metres
 * @property {(ground: XY) => XY|null} point where a ground point is seen
 * @property {(placed: Placed) => XY|null} foot
 * @property {(placed: Placed) => Rectangle|null} box null: not visible
 * @property {(placed: Placed) => Axes|null} axes
 * @property {(frame: number, transform: Transform, ratio: number) => PictureState} picture
 * @property {(frame: number) => void} retry
 * @property {(ctx: CanvasRenderingContext2D, transform: Transform, frame: number, options: Options, ratio: number) => void} paintBackground
 * @property {(ctx: CanvasRenderingContext2D, transform: Transform, options: Options) => void} paintGuides
 * @property {(person: Person, look: Look, transform: Transform, options: Options) => PersonItem} item of one visible person
 *
 * @typedef {Pane & {transform: Transform}} LaidOutPane one that has room, as every pane that paints
 * @typedef {(pane: LaidOutPane) => Item[]} Extra
 * @typedef {{frame: number, people: ReadonlyMap<number, Person>, selection: number|null, options: Options,
 *            extras: Extra}} Model
 */
export class Pane {
  /** @param {View} view @param {Model} model read at every paint */
  constructor(view, model) {
    this.view = view;
    this._model = model;
    /** @type {Item[]} */
    this._items = [];
    /** @type {Map<number, PersonItem>} */
    this._known = new Map(); // person → item, as long as neither the person nor the way of drawing changes
    this._dirty = { picture: true, marks: true };
    this._ratio = 1;
    this.room = { width: 0, height: 0 };
    /** @type {Transform|null} */
    this.transform = null; // without room there is none
    this._fitted = true;
    this._picture = element("canvas", { className: "pane-picture" });
    this._marks = element("canvas", { className: "pane-marks" });
    this._note = element("p", { className: "pane-note", hidden: true });
    this._retry = element(
      "button",
      { type: "button", className: "pane-retry", hidden: true, onclick: () => this.view.retry(this._model.frame) },
      gettext("Try again"),
    );
    this.element = element(
      "section",
      { className: "pane", "data-view": this.view.id, "aria-label": this.view.title },
      this._picture,
      this._marks,
      element("h2", { className: "pane-title" }, this.view.title),
      element("div", { className: "pane-message" }, this._note, this._retry),
    );
    this._observer = new ResizeObserver(() => this._resize());
    this._observer.observe(this.element);
  }

  /** The picture, guides included, has to be painted again. */
  markPicture() {
    this._dirty.picture = true;
    paintSoon(this);
  }

  /** People or selection changed; `all` also when nothing but the style did. */
  markPeople(all = false) {
    this._dirty.marks ||= all;
    paintSoon(this);
  }

  get hidden() {
    return this.element.hidden;
  }

  set hidden(hidden) {
    this.element.hidden = hidden;
  }

  /**
   * A filter of the page over the picture.
   * @param {string} filter
   */
  setFilter(filter) {
    this._picture.style.filter = filter;
  }

  /** Take up the room there is now, not only after the next layout. */
  measure() {
    this._resize();
  }

  get fitted() {
    return this._fitted;
  }

  fit() {
    if (this.room.width) this._use(fit(this.view.size, this.room), true);
  }

  /**
   * Change pan and zoom; refuses to lose the picture.
   * @param {Transform} transform
   */
  look(transform) {
    const next = clamped(transform, this.view.size, this.room, this.view.largest);
    this._use(next, next.equals(fit(this.view.size, this.room)));
  }

  /**
   * A pointer event's place, in units of the pane.
   * @param {MouseEvent} event @returns {XY}
   */
  local(event) {
    const bounds = this.element.getBoundingClientRect();
    return { x: (event.clientX - bounds.left) / unit(), y: (event.clientY - bounds.top) / unit() };
  }

  /**
   * Where a place of the pane is in the window, in CSS pixels.
   * @param {XY} place @returns {XY}
   */
  global({ x, y }) {
    const bounds = this.element.getBoundingClientRect();
    return { x: bounds.left + x * unit(), y: bounds.top + y * unit() };
  }

  paint() {
    if (!isLaidOut(this) || this.hidden) return;
    if (this._dirty.picture) this._paintPicture(this.transform);
    this._paintMarks(this, this._dirty.marks);
    this._dirty = { picture: false, marks: false };
  }

  remove() {
    this._observer.disconnect();
    this.element.remove();
  }

  _resize() {
    const [width, height] = [this.element.clientWidth / unit(), this.element.clientHeight / unit()];
    const ratio = (window.devicePixelRatio || 1) * unit();
    const before = this.room;
    if (!width || !height || (width === before.width && height === before.height && ratio === this._ratio)) return;
    this._ratio = ratio;
    for (const canvas of [this._picture, this._marks]) {
      canvas.width = Math.round(width * this._ratio);
      canvas.height = Math.round(height * this._ratio);
    }
    this.room = { width, height };
    if (!this.transform || this._fitted) this.fit();
    else this.look(resized(this.transform, before, this.room));
    this._markAll();
    this.paint(); // resizing a canvas empties it: no blank frame in between
  }

  /** @param {Transform} transform @param {boolean} fitted */
  _use(transform, fitted) {
    this._fitted = fitted;
    if (this.transform?.equals(transform)) return;
    this.transform = transform;
    this.element.dataset.zoom = (transform.scale / fit(this.view.size, this.room).scale).toFixed(3);
    this._markAll();
  }

  _markAll() {
    this._dirty = { picture: true, marks: true };
    paintSoon(this);
  }

  /** @param {Transform} transform */
  _paintPicture(transform) {
    const { frame, options } = this._model;
    const ctx = this._context(this._picture);
    ctx.clearRect(0, 0, this.room.width, this.room.height);
    this.view.paintBackground(ctx, transform, frame, options, this._ratio);
    this.view.paintGuides(ctx, transform, options);
    this._showPictureState(this.view.picture(frame, transform, this._ratio));
  }

  /** @param {PictureState} state */
  _showPictureState({ status, error }) {
    this.element.dataset.picture = status;
    this._note.hidden = status === "ready";
    this._retry.hidden = status !== "error";
    if (status === "error") setText(this._note, gettext("The image did not arrive: {error}", { error }));
    else if (status !== "ready") setText(this._note, gettext("Loading image…"));
  }

  /** @param {LaidOutPane} pane this one @param {boolean} all */
  _paintMarks(pane, all) {
    if (all) this._known.clear();
    const items = [...this._peopleItems(pane.transform), ...this._model.extras(pane)];
    const whole = { xmin: 0, ymin: 0, xmax: this.room.width, ymax: this.room.height };
    const dirty = all ? whole : damage(this._items, items);
    this._items = items;
    if (!dirty || !overlaps(dirty, whole)) return;
    const ctx = this._context(this._marks);
    const [left, top] = [Math.floor(dirty.xmin), Math.floor(dirty.ymin)];
    const [width, height] = [Math.ceil(dirty.xmax) - left, Math.ceil(dirty.ymax) - top];
    ctx.save();
    ctx.beginPath();
    ctx.rect(left, top, width, height);
    ctx.clip();
    ctx.clearRect(left, top, width, height);
    for (const item of items) if (overlaps(item.bounds, dirty)) item.draw(ctx);
    ctx.restore();
  }

  /**
   * One item per visible person, far ones first, the selected one last.
   * @param {Transform} transform
   */
  _peopleItems(transform) {
    const { people, selection, options } = this._model;
    /** @type {Map<number, PersonItem>} */
    const known = new Map();
    for (const annotation of people.values()) {
      if (!this.view.box(annotation)) continue;
      const look = lookOf(annotation, annotation.person === selection);
      const old = this._known.get(annotation.person);
      const stays = old?.what === annotation && old.look === look.name;
      known.set(annotation.person, stays ? old : this.view.item(annotation, look, transform, options));
    }
    this._known = known;
    return [...known.values()].sort((one, other) => one.order - other.order);
  }

  /** @param {HTMLCanvasElement} canvas */
  _context(canvas) {
    const ctx = contextOf(canvas);
    ctx.setTransform(this._ratio, 0, 0, this._ratio, 0, 0); // the only place that knows device pixels
    return ctx;
  }
}

/** @param {Pane} pane @returns {pane is LaidOutPane} */
function isLaidOut(pane) {
  return pane.transform !== null;
}
