import { failureWords } from "../../base/failure_words.js";
import { gettext } from "../../base/messages.js";
import { changed } from "../../truth/annotation.js";
import { patch } from "../../truth/commands.js";

const STEP = { height: 0.02, radius: 0.01 }; // metres
/** @type {readonly Size[]} */
const SIZES = ["height", "radius"];

/**
 * Height and width of people. Who gets a size of their own keeps it in all later frames.
 * @typedef {import("../../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../../truth/scene.js").Scene} Scene
 * @typedef {import("../../truth/store.js").Store} Store
 * @typedef {"height"|"radius"} Size
 * @typedef {Partial<Record<Size, number|null>>} SizeValues metres; null: the dataset's cylinder
 */
export class Sizes {
  /**
   * @param {object} parts
   * @param {Scene} parts.scene
   * @param {Store} parts.store
   * @param {import("../../truth/history.js").History} parts.history
   * @param {import("./guard.js").Guard} parts.guard
   * @param {import("../../saving/loader.js").Loader} parts.loader
   * @param {import("../../base/notices.js").Notices} parts.notices
   */
  constructor({ scene, store, history, guard, loader, notices }) {
    this.scene = scene;
    this.store = store;
    this.history = history;
    this.guard = guard;
    this.loader = loader;
    this.notices = notices;
    this._loading = false;
  }

  /** Rows for the table of actions. */
  table() {
    return {
      taller: () => this.step("height", 1),
      shorter: () => this.step("height", -1),
      wider: () => this.step("radius", 1),
      narrower: () => this.step("radius", -1),
      usualSize: () => this.reset(),
    };
  }

  /** @param {Size} name @param {1|-1} direction */
  step(name, direction) {
    const person = this.guard.selected();
    if (!person) return;
    const now = this.scene.cylinderOf(person)[name];
    const next = allowed(this.scene, name, (Math.round(now / STEP[name]) + direction) * STEP[name]);
    if ((next - now) * direction > 0) this.set(person, { [name]: next });
    else this.guard.say(this.guard.besideFoot(person), limitWords(this.scene, name));
  }

  reset() {
    const person = this.guard.selected();
    if (person) this.set(person, { height: null, radius: null });
  }

  /** @param {Annotation} person @param {SizeValues} values */
  async set(person, values) {
    if (Object.values(values).some((value) => value !== null) && this.refused()) return;
    if (!(await this._laterFramesLoaded())) return;
    const current = this.store.person(person.person);
    if (!current) return;
    this.history.run(resize(this.store, person.person, this._withDefaults(values)));
    const { height, radius } = this.scene.cylinderOf(this.store.marked(person.person));
    const words = { person: person.person, height: height.toFixed(2), width: (2 * radius).toFixed(2) };
    this.guard.say(this.guard.besideFoot(current), gettext("Person {person}: {height} m tall, {width} m wide", words));
  }

  /**
   * Tables hold the usual size only: where a view has nothing else, nobody gets a size of their own, and that is said.
   * @param {import("./guard.js").Where} [place]
   */
  refused(place = null) {
    const unknown = [];
    for (const { byTable, name } of this.scene.cameras) if (byTable) unknown.push(name);
    if (!unknown.length) return false;
    this.guard.say(
      place,
      gettext("Everybody keeps the usual size here: this page does not know the lens of {views}", {
        views: unknown.join(", "),
      }),
    );
    return true;
  }

  /**
   * The usual size is no size of one's own.
   * @param {SizeValues} values @returns {SizeValues}
   */
  _withDefaults(values) {
    const own = { ...values };
    for (const name of SIZES) {
      const value = own[name];
      if (typeof value === "number" && Math.abs(value - this.scene.cylinder[name]) < 1e-6) own[name] = null;
    }
    return own;
  }

  /** Long layers are loaded in pieces; the later frames have to be there to be changed. */
  async _laterFramesLoaded() {
    const { store } = this;
    const missing = () =>
      store.numbers.slice(store.numbers.indexOf(store.current)).find((number) => !store.frame(number).loaded);
    if (missing() === undefined) return true;
    if (this._loading) return false;
    this._loading = true;
    this.notices.say(gettext("Loading the later frames: the person keeps this size in them"));
    try {
      for (let number = missing(); number !== undefined; number = missing()) await this.loader.load(number, false);
      return true;
    } catch (error) {
      this.notices.say(gettext("The later frames did not arrive: {error}", { error: failureWords(error) }));
      return false;
    } finally {
      this._loading = false;
    }
  }
}

/**
 * A size from this frame on, wherever the person occurs: one step to undo.
 * @param {Store} store @param {number} person @param {SizeValues} values
 */
export function resize(store, person, values) {
  const later = store.numbers.slice(store.numbers.indexOf(store.current));
  const edits = later
    .filter((number) => store.person(person, number))
    .map((number) => ({ frame: number, person, after: changed(store.marked(person, number), values) }));
  return patch(store, gettext("change the size of person {person}", { person }), edits, {
    select: person,
    group: `size ${store.current} ${person}`,
  });
}

/**
 * The height (metres, whole centimetres) whose rectangle in a view ends at `top`.
 * @param {Scene} scene @param {import("../../views/pane.js").Pane["view"]} view
 * @param {Annotation} person @param {number} top image pixels
 */
export function heightReaching(scene, view, person, top) {
  let [low, high] = scene.sizes.height;
  while (high - low > 0.005) {
    const middle = (low + high) / 2;
    const box = view.box(changed(person, { height: middle }));
    if (!box || box.ymin < top)
      high = middle; // too tall to be seen counts as too tall
    else low = middle;
  }
  return allowed(scene, "height", Math.round(low * 100) / 100);
}

/** @param {Scene} scene @param {Size} name */
function limitWords(scene, name) {
  const [least, most] = scene.sizes[name];
  const words = { least: inWords(name, least), most: inWords(name, most) };
  if (name === "radius") return gettext("People are {least} to {most} m wide", words);
  return gettext("People are {least} to {most} m tall", words);
}

/** @param {Size} name @param {number} metres */
function inWords(name, metres) {
  return (name === "radius" ? 2 * metres : metres).toFixed(2);
}

/** @param {Scene} scene @param {Size} name @param {number} metres */
function allowed(scene, name, metres) {
  const [least, most] = scene.sizes[name];
  return Number(Math.min(Math.max(metres, least), most).toFixed(3));
}
