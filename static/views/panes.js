import { element } from "../base/dom.js";
import { Emitter } from "../base/emitter.js";
import { gettext } from "../base/messages.js";
import { CameraView } from "./camera_view.js";
import { MapView } from "./map_view.js";
import { Pane } from "./pane.js";
import { overlaps } from "./regions.js";
import { focus } from "./transform.js";

const SHARE = 0.5; // of a pane's height for a zoomed person
const [ABOVE_FEET, BELOW_FEET] = [0.25, 0.05]; // of a person's height, shown close up

/**
 * @typedef {import("../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../truth/scene.js").Scene} Scene
 * @typedef {import("../truth/store.js").Store} Store
 * @typedef {import("./display.js").Options} Options
 * @typedef {import("./images.js").Images} Images
 * @typedef {import("./pane.js").Extra} Extra
 * @typedef {import("./pane.js").LaidOutPane} LaidOutPane
 * @typedef {import("./pane.js").Model} Model
 * @typedef {import("./pane.js").Person} Person
 * @typedef {import("./pane.js").View} View
 * @typedef {import("./regions.js").Rectangle} Rectangle
 * @typedef {((name: "change", listener: (value: {frames: ReadonlySet<number>}) => void) => void)
 *   & ((name: "selection", listener: (value: {after: number|null}) => void) => void)
 *   & ((name: "frame", listener: () => void) => void)} Listen
 * @typedef {Panes<Person, unknown>} AnyPanes whoever is in them
 */

/**
 * What panes have to know of a store; a comparison has one of its own.
 * @template {Person} One
 * @typedef {object} Watched
 * @property {number} current number of the open frame
 * @property {number|null} selection
 * @property {() => Map<number, One>} people of the open frame
 * @property {() => One|undefined} selected
 * @property {Listen} on
 */

/**
 * @template {Person} One
 * @template Kept
 * @typedef {object} Parts
 * @property {Scene} scene
 * @property {Kept & Watched<One>} store
 * @property {Images} images
 * @property {Options} options
 * @property {(() => Map<number, One>)|null} [people] whom the panes draw, if not the people of the open frame
 */

/**
 * All panes and what they have in common: options, the active view, zoom to the selected person. It listens to
 * the store and marks what has to be painted again. Emits `active` {view}, `zoom` {on} and `options`.
 * @template {Person} [One=Annotation]
 * @template [Kept=Store]
 * @extends {Emitter<{active: {view: View}, zoom: {on: boolean}, options: void}>}
 */
export class Panes extends Emitter {
  /** @param {Parts<One, Kept>} parts */
  constructor({ scene, store, images, options, people = null }) {
    super();
    this.scene = scene;
    this.store = store;
    this.options = options;
    this.zoomed = false;
    this.closeUp = false; // zoom shows the feet instead of the whole person
    /** @type {One|null} */
    this.preview = null; // a person as an unfinished drag shows them
    this._people = people;
    /** @type {Extra[]} */
    this._extras = [];
    this.element = element("div", { className: "panes" });
    const model = this._model();
    /** @type {View[]} */
    const views = scene.cameras.map((_, index) => new CameraView(scene, index, images));
    views.push(new MapView(scene, gettext("Ground from above")));
    this.all = views.map((view) => new Pane(view, model));
    this.element.append(...this.all.map((pane) => pane.element));
    this.active = this.all[0];
    this.active.element.classList.add("active");
    this._follow(store, images);
    scene.ownSizes?.on("change", () => this.markPeople(true)); // boxes nobody knew when people were drawn
  }

  /**
   * Something drawn over the people: `(pane) => items`, asked at every paint.
   * @param {Extra} extra
   */
  addExtra(extra) {
    this._extras.push(extra);
  }

  /** @param {Pane} pane */
  activate(pane) {
    if (pane === this.active) return;
    this.active.element.classList.remove("active");
    pane.element.classList.add("active");
    this.active = pane;
    this.markPeople();
    this.emit("active", { view: pane.view });
  }

  /** Those that are not hidden; there is always one. */
  get shown() {
    return this.all.filter((pane) => !pane.hidden);
  }

  markPeople(all = false) {
    for (const pane of this.all) pane.markPeople(all);
  }

  markPictures() {
    for (const pane of this.all) pane.markPicture();
  }

  /**
   * A person drawn elsewhere, or larger, than the store says.
   * @param {One|null} annotation
   */
  showPreview(annotation) {
    if (annotation === this.preview) return;
    this.preview = annotation;
    this.markPeople();
  }

  /**
   * The people of the open frame as they are drawn.
   * @returns {Map<number, One>}
   */
  people() {
    if (this._people) return this._people();
    const people = this.store.people();
    return this.preview ? new Map(people).set(this.preview.person, this.preview) : people;
  }

  /**
   * An option of display changed.
   * @template {keyof Options} Name
   * @param {Name} name @param {Options[Name]} value
   */
  set(name, value) {
    this.options[name] = value;
    this.markPictures();
    this.markPeople(true);
    this.emit("options");
  }

  /**
   * Every view to the selected person, or back to the whole picture.
   * @param {boolean} on
   */
  zoom(on) {
    this.zoomed = on && this.store.selected() !== undefined;
    for (const pane of this.shown) {
      if (this.zoomed) this._zoomIn(pane);
      else pane.fit();
    }
    this.emit("zoom", { on: this.zoomed });
  }

  /** @param {Pane} pane */
  _zoomIn(pane) {
    const box = this._shownPart(pane, this.store.selected());
    if (!box) return pane.fit();
    const grown = pane.view.index === null ? grow(box, 1.2) : box;
    pane.look(focus(grown, pane.room, SHARE, pane.view.largest));
  }

  /**
   * What of a person zoom makes large: from above, and unless close up, everything.
   * @param {Pane} pane @param {One|undefined} person @returns {Rectangle|null}
   */
  _shownPart(pane, person) {
    const box = person ? pane.view.box(person) : null;
    if (!box || !this.closeUp || pane.view.index === null) return box;
    const height = box.ymax - box.ymin;
    return { ...box, ymin: box.ymax - ABOVE_FEET * height, ymax: box.ymax + BELOW_FEET * height };
  }

  /** While zoomed, a person that is moved out of sight is brought back. */
  _keepInSight() {
    const person = this.store.selected();
    if (!this.zoomed || !person) return;
    for (const pane of this.shown) {
      const box = this._shownPart(pane, person);
      if (!box || !pane.transform) continue;
      const { x: xmin, y: ymin } = pane.transform.toPane(box.xmin, box.ymin);
      const { x: xmax, y: ymax } = pane.transform.toPane(box.xmax, box.ymax);
      const room = { xmin: 0, ymin: 0, xmax: pane.room.width, ymax: pane.room.height };
      const inside = xmin >= 0 && ymin >= 0 && xmax <= room.xmax && ymax <= room.ymax;
      if (!inside || !overlaps({ xmin, ymin, xmax, ymax }, room)) this._zoomIn(pane);
    }
  }

  /** Panes that were zoomed by hand go to a selected person they do not show, and stay as large as they are. */
  _showSelected() {
    const person = this.store.selected();
    if (!person) return;
    for (const pane of this.shown) {
      const box = !pane.fitted && pane.view.box(person);
      if (!box || !pane.transform) continue;
      const { x, y } = pane.transform.toPane((box.xmin + box.xmax) / 2, (box.ymin + box.ymax) / 2);
      const { width, height } = pane.room;
      if (x < 0 || y < 0 || x > width || y > height) pane.look(pane.transform.moved(width / 2 - x, height / 2 - y));
    }
  }

  /** @param {Watched<One>} store @param {Images} images */
  _follow(store, images) {
    store.on("change", ({ frames }) => {
      if (!frames.has(store.current)) return;
      this.markPeople();
      this._keepInSight();
    });
    store.on("selection", ({ after }) => {
      this.markPeople();
      if (this.zoomed) this.zoom(after !== null);
      else this._showSelected();
    });
    store.on("frame", () => this.markPictures());
    images.on("picture", ({ frame, camera }) => {
      if (frame === store.current) this.all.find((pane) => pane.view.index === camera)?.markPicture();
    });
  }

  /** @returns {Model} */
  _model() {
    const panes = this;
    return {
      options: this.options,
      get frame() {
        return panes.store.current;
      },
      get people() {
        return panes.people();
      },
      get selection() {
        return panes.store.selection;
      },
      /** @param {LaidOutPane} pane */
      extras: (pane) => this._extras.flatMap((extra) => extra(pane)),
    };
  }
}

/** @param {Rectangle} box @param {number} metres @returns {Rectangle} */
function grow(box, metres) {
  return { xmin: box.xmin - metres, ymin: box.ymin - metres, xmax: box.xmax + metres, ymax: box.ymax + metres };
}
