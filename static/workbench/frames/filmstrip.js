import { element, setText } from "../../base/dom.js";
import { gettext } from "../../base/messages.js";
import { paintSoon } from "../../base/repaint.js";
import { unit } from "../../base/scale.js";
import { between } from "../../truth/keyframes.js";
import { predictPeople } from "../../truth/propagation.js";
import { paintCrop } from "../../views/crop_paint.js";
import { bestViews } from "../../views/crops.js";

const VIEWS = 3; // crops per frame
const REACH = 5; // frames on each side of the open one, where all do not fit
const GAP = 2; // CSS pixels between crops
const HEAD = 16; // CSS pixels for the frame's number

/**
 * @typedef {import("../../truth/annotation.js").Annotation} Annotation
 * @typedef {{number: number, here: boolean, one: Annotation|null}} Step a frame, and where the person is or would be there
 * @typedef {{width: number, height: number}} Room
 */

/**
 * The selected person over all frames of the batch, in the three views that show the person best; a click goes
 * there. One canvas; a crop is painted again only when its picture or its box changed.
 */
export class Filmstrip {
  /**
   * @param {object} parts
   * @param {import("../../truth/scene.js").Scene} parts.scene
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {import("../../saving/loader.js").Loader} parts.loader
   * @param {import("../../views/images.js").Images} parts.images
   * @param {import("./navigation.js").Navigation} parts.navigation
   * @param {import("../../views/panes.js").Panes} parts.panes
   * @param {import("../settings.js").Settings} parts.settings
   */
  constructor({ scene, store, loader, images, navigation, panes, settings }) {
    this.scene = scene;
    this.store = store;
    this.loader = loader;
    this.images = images;
    this.navigation = navigation;
    this.panes = panes;
    this.settings = settings;
    /** @type {Promise<void>|null} */
    this._fetching = null;
    /** @type {Map<number, unknown[]>} frame → what it shows */
    this._painted = new Map();
    /** @type {string|null} frames and views that are arranged */
    this._layout = null;
    /** @type {Room|null} null before the canvas has a size */
    this._room = null;
    this._ratio = 1;
    this._canvas = element("canvas", {});
    this._buttons = element("div", { className: "filmstrip-frames" });
    this._note = element("p", { className: "filmstrip-note" });
    this.element = element(
      "section",
      { className: "filmstrip", "aria-label": gettext("The selected person over the frames") },
      this._canvas,
      this._buttons,
      this._note,
    );
    this._observer = new ResizeObserver(() => this._resize());
    this._observer.observe(this._canvas);
    for (const event of /** @type {const} */ (["change", "selection", "frame"])) store.on(event, () => this._later());
    images.on("picture", () => this._later());
    settings.watch("filmstrip", (shown) => this._show(shown));
  }

  get shown() {
    return !this.element.hidden;
  }

  /** @param {boolean} shown */
  _show(shown) {
    this.element.hidden = !shown;
    this.navigation.lookAround(shown ? REACH : 0);
    if (shown) this._later();
  }

  _later() {
    if (this.shown) paintSoon(this);
  }

  _resize() {
    const [width, height] = [this._canvas.clientWidth / unit(), this._canvas.clientHeight / unit()];
    if (!width || !height) return;
    this._ratio = (window.devicePixelRatio || 1) * unit();
    Object.assign(this._canvas, { width: Math.round(width * this._ratio), height: Math.round(height * this._ratio) });
    this._room = { width, height };
    this._painted.clear();
    this.paint();
  }

  paint() {
    const person = this.store.selection ?? this.navigation.held;
    setText(this._note, person === null ? gettext("Select somebody to see the person over all frames here") : "");
    const room = this._room;
    if (!room) return;
    if (person === null) return this._clear(room);
    const numbers = this._numbers();
    const steps = numbers.map((number) => this._step(person, number));
    const known = steps.flatMap(({ here, one }) => (here && one ? one : []));
    const views = bestViews(this.scene, known, VIEWS);
    const layout = `${person} ${numbers} ${views}`;
    if (layout !== this._layout) this._arrange(room, layout, person, numbers, views);
    steps.forEach((step, column) => this._paintFrame(room, step, column, numbers.length, views));
  }

  /** The frames there is room for: all of a batch, of a long layer those around the open one. */
  _numbers() {
    const { numbers, current } = this.store;
    const most = 2 * REACH + 1;
    if (numbers.length <= most) return numbers;
    const first = Math.max(0, Math.min(numbers.indexOf(current) - REACH, numbers.length - most));
    return numbers.slice(first, first + most);
  }

  /**
   * The person in a frame, or where one would look for him.
   * @param {number} person @param {number} number @returns {Step}
   */
  _step(person, number) {
    if (!this.store.frame(number).loaded) {
      this._fetch(number);
      return { number, here: false, one: null };
    }
    const here = this.store.person(person, number);
    if (here) return { number, here: true, one: here };
    const middle = between(this.store, this.scene, person, number);
    return { number, here: false, one: middle ?? this._expected(person, number) };
  }

  /**
   * A piece of a long layer at a time; when the network is away, the next repaint asks again.
   * @param {number} number
   */
  _fetch(number) {
    const done = () => {
      this._fetching = null;
    };
    this._fetching ??= this.loader.load(number, false).then(done, done);
  }

  /** @param {number} person @param {number} number */
  _expected(person, number) {
    const { store, scene } = this;
    /** @param {number} one */
    const distance = (one) => Math.abs(one - number);
    const known = store.numbers
      .filter((one) => store.person(person, one))
      .sort((one, other) => distance(one) - distance(other));
    const sources = known
      .filter((one) => one > number === known[0] > number)
      .map((one) => ({ time: scene.seconds(one), people: new Map([[person, store.marked(person, one)]]) }));
    return predictPeople(scene.grid, scene.seconds(number), sources)[0] ?? null;
  }

  /** @param {Room} room */
  _clear(room) {
    this._layout = null;
    this._painted.clear();
    this._buttons.replaceChildren();
    this._context().clearRect(0, 0, room.width, room.height);
  }

  /**
   * Other frames or views: everything is painted anew, and every frame gets its button.
   * @param {Room} room @param {string} layout @param {number} person @param {number[]} numbers @param {number[]} views
   */
  _arrange(room, layout, person, numbers, views) {
    this._clear(room);
    this._layout = layout;
    this._buttons.replaceChildren(...numbers.map((number) => this._button(person, number, views)));
  }

  /** @param {number} person @param {number} number @param {number[]} views */
  _button(person, number, views) {
    const place = this.store.numbers.indexOf(number) + 1;
    const label = gettext("Person {person} in frame {place}", { person, place });
    return element("button", {
      type: "button",
      "aria-label": label,
      title: label,
      onclick: (event) => this._go(event, person, number, views),
    });
  }

  /**
   * A click in a crop also makes its view the active one.
   * @param {MouseEvent} event @param {number} person @param {number} number @param {number[]} views
   */
  async _go(event, person, number, views) {
    const button = event.currentTarget;
    if (!(button instanceof HTMLElement)) return;
    const { left, width } = button.getBoundingClientRect();
    const view = views[Math.floor(((event.clientX - left) / width) * views.length)];
    if (event.detail > 0) button.blur();
    await this.navigation.jump(number);
    if (this.store.current !== number) return; // it could not be loaded
    this.store.select(person);
    const pane = this.panes.all.find((one) => one.view.index === view);
    if (pane && event.detail > 0) this.panes.activate(pane);
  }

  /** @param {Room} room @param {Step} step @param {number} column @param {number} columns @param {number[]} views */
  _paintFrame(room, step, column, columns, views) {
    const { number, one, here } = step;
    const width = room.width / columns;
    const left = column * width;
    const current = number === this.store.current;
    const across = (width - GAP * (views.length + 1)) / Math.max(1, views.length);
    const cells = views.map((view, index) => ({
      x: left + GAP + index * (across + GAP),
      y: HEAD,
      width: across,
      height: room.height - HEAD - GAP,
      view,
      picture: this._picture(number, view),
    }));
    const shows = [one, here, current, ...cells.map(({ picture }) => picture)];
    if (same(shows, this._painted.get(number))) return;
    this._painted.set(number, shows);
    const ctx = this._context();
    ctx.clearRect(left, 0, width, room.height);
    this._paintHead(ctx, left, width, number, current);
    for (const cell of cells) paintCrop(ctx, this.scene, cell, one, here);
  }

  /**
   * @param {CanvasRenderingContext2D} ctx @param {number} left @param {number} width @param {number} number @param {boolean} current
   */
  _paintHead(ctx, left, width, number, current) {
    const style = getComputedStyle(this.element);
    ctx.fillStyle = current ? style.outlineColor : style.color;
    ctx.font = `${current ? 700 : 400} 11px system-ui, 'DejaVu Sans', sans-serif`;
    ctx.textAlign = "center";
    ctx.textBaseline = "middle";
    ctx.fillText(String(this.store.numbers.indexOf(number) + 1), left + width / 2, HEAD / 2);
    if (current) ctx.fillRect(left + GAP, HEAD - 2, width - 2 * GAP, 2);
  }

  /**
   * Light is enough; full resolution where it is there anyway.
   * @param {number} number @param {number} view
   */
  _picture(number, view) {
    const full = this.images.peek(number, view, "full");
    return full ?? this.images.get(number, view, "light").bitmap;
  }

  _context() {
    const ctx = /** @type {CanvasRenderingContext2D} */ (this._canvas.getContext("2d"));
    ctx.setTransform(this._ratio, 0, 0, this._ratio, 0, 0);
    return ctx;
  }
}

/** @param {unknown[]} one @param {unknown[]|undefined} other */
function same(one, other) {
  return other !== undefined && one.length === other.length && one.every((value, index) => value === other[index]);
}
