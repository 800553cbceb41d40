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
 * All panes and what they have in common: options, the active view, zoom to the selected person. It listens to
 * the store and marks what has to be painted again. Emits `active` {view}, `zoom` {on} and `options`.
 */
export class Panes extends Emitter {
  /** @param {{people?: () => Map<number, object>}} parts `people`: whom the panes draw, if not the people of the open frame */
  constructor({ scene, store, images, options, people = null }) {
    super();
    this.scene = scene;
    this.store = store;
    this.options = options;
    this.zoomed = false;
    this.closeUp = false; // zoom shows the feet instead of the whole person
    this.preview = null; // a person as an unfinished drag shows them
    this._people = people;
    this._extras = [];
    this.element = element("div", { className: "panes" });
    const model = this._model();
    const views = scene.cameras.map((_, index) => new CameraView(scene, index, images));
    views.push(new MapView(scene, gettext("Ground from above")));
    this.all = views.map((view) => new Pane(view, model));
    this.element.append(...this.all.map((pane) => pane.element));
    this.active = this.all[0];
    this.active.element.classList.add("active");
    this._follow(store, images);
    scene.ownSizes?.on("change", () => this.markPeople(true)); // boxes nobody knew when people were drawn
  }

  /** Something drawn over the people: `(pane) => items`, asked at every paint. */
  addExtra(extra) {
    this._extras.push(extra);
  }

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

  /** A person drawn elsewhere, or larger, than the store says. */
  showPreview(annotation) {
    if (annotation === this.preview) return;
    this.preview = annotation;
    this.markPeople();
  }

  /** The people of the open frame as they are drawn. */
  people() {
    if (this._people) return this._people();
    const people = this.store.people();
    return this.preview ? new Map(people).set(this.preview.person, this.preview) : people;
  }

  /** An option of display changed. */
  set(name, value) {
    this.options[name] = value;
    this.markPictures();
    this.markPeople(true);
    this.emit("options");
  }

  /** Every view to the selected person, or back to the whole picture. */
  zoom(on) {
    this.zoomed = on && this.store.selected() !== undefined;
    for (const pane of this.shown) {
      if (this.zoomed) this._zoomIn(pane);
      else pane.fit();
    }
    this.emit("zoom", { on: this.zoomed });
  }

  _zoomIn(pane) {
    const box = this._shownPart(pane, this.store.selected());
    if (!box) return pane.fit();
    const grown = pane.view.index === null ? grow(box, 1.2) : box;
    pane.look(focus(grown, pane.room, SHARE, pane.view.largest));
  }

  /** What of a person zoom makes large: from above, and unless close up, everything. */
  _shownPart(pane, person) {
    const box = person && pane.view.box(person);
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
      if (!box) continue;
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
      if (!box) continue;
      const { x, y } = pane.transform.toPane((box.xmin + box.xmax) / 2, (box.ymin + box.ymax) / 2);
      const { width, height } = pane.room;
      if (x < 0 || y < 0 || x > width || y > height) pane.look(pane.transform.moved(width / 2 - x, height / 2 - y));
    }
  }

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
      extras: (pane) => this._extras.flatMap((extra) => extra(pane)),
    };
  }
}

function grow(box, metres) {
  return { xmin: box.xmin - metres, ymin: box.ymin - metres, xmax: box.xmax + metres, ymax: box.ymax + metres };
}
