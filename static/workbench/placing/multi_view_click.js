import { gettext } from "../../base/messages.js";
import { groundPoint } from "../../geometry/triangulation.js";
import { crossItem, lineItem, readoutItem } from "../../views/hints_on_ground.js";
import { CYAN } from "../../views/styles.js";

const DOUBTFUL = 8; // pixels a click may miss the point that fits all clicks best
const SHOWN = 8000; // ms
const BAD = "#ff8f86";

/**
 * The same person's feet clicked in several views. The place is where the rays meet best; how far every click
 * is off in its view tells bad clicks and bad calibration. Clicks count as long as nobody moves the person
 * by other means.
 * @typedef {import("../../truth/ground_point.js").XY} XY
 * @typedef {import("../../views/pane.js").Pane} Pane
 * @typedef {import("./guard.js").Where} Where
 * @typedef {import("./heads.js").Pixel} Pixel
 * @typedef {Map<number, Pixel>} Clicks by the indices of their cameras
 * @typedef {{index: number, pixel: Pixel, seen: XY, residual: number}} Sighting a click, where the place they all
 *   give is seen, and how many pixels are between
 */
export class MultiViewClick {
  /**
   * @param {object} parts
   * @param {import("../../truth/scene.js").Scene} parts.scene
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {import("../../views/panes.js").Panes} parts.panes
   * @param {import("./guard.js").Guard} parts.guard
   */
  constructor({ scene, store, panes, guard }) {
    this._scene = scene;
    this._store = store;
    this._panes = panes;
    this._guard = guard;
    /** @type {import("../../truth/annotation.js").Annotation|null} the person as the clicks have put them */
    this._annotation = null;
    /** @type {number|null} */
    this._frame = null;
    /** @type {Clicks} */
    this._clicks = new Map();
    /** @type {Sighting[]|null} shown for a while */
    this._result = null;
    /** @type {ReturnType<typeof setTimeout>|undefined} */
    this._timer = undefined;
    panes.addExtra(/** @param {Pane} pane */ (pane) => this._items(pane));
    store.on("change", () => this._result && !this._valid() && this._show(null));
    store.on("frame", () => this._show(null));
    store.on("selection", () => this._show(null));
  }

  /**
   * A first click has put the selected person where it is.
   * @param {Pane} pane @param {Pixel} pixel
   */
  begin(pane, pixel) {
    this._clicks = new Map();
    this._remember(pane, pixel);
    this._show(null);
  }

  /**
   * One more click on the feet of the selected person, if there was one in another view before.
   * @param {Pane} pane @param {Pixel} pixel @param {Where} event where it is said what came of it
   * @param {(position: number) => boolean} move puts the person there if possible
   * @returns {boolean} false: this is the first click
   */
  add(pane, pixel, event, move) {
    const { index } = pane.view;
    if (index === null || !this._valid() || [...this._clicks.keys()].every((one) => one === index)) return false;
    const found = this._meeting(new Map(this._clicks).set(index, pixel));
    const position = found && this._scene.positionAt(found);
    if (!found || position === null) {
      this._guard.say(event, gettext("These clicks do not meet in the ground area: is it the same person?"));
      return true;
    }
    if (!move(position)) return true;
    this._remember(pane, pixel);
    this._show(found.clicks);
    this._guard.say(event, this._words(found.clicks));
    return true;
  }

  /** @param {Pane} pane @param {Pixel} pixel */
  _remember(pane, pixel) {
    if (pane.view.index === null) this._clicks = new Map();
    else this._clicks.set(pane.view.index, pixel);
    this._annotation = this._store.selected() ?? null;
    this._frame = this._store.current;
  }

  _valid() {
    return (
      this._annotation !== null && this._frame === this._store.current && this._store.selected() === this._annotation
    );
  }

  /**
   * Where the rays meet best, in metres, and how far every click is off.
   * @param {Clicks} clicks @returns {XY & {clicks: Sighting[]}|null}
   */
  _meeting(clicks) {
    const entries = [...clicks];
    const { cameras } = this._scene;
    const point = groundPoint(entries.map(([index, { x, y, z }]) => ({ camera: cameras[index], u: x, v: y, z })));
    if (!point) return null;
    const shown = entries.map(([index, pixel], place) => ({
      index,
      pixel,
      seen: this._scene.toImage(index, point, pixel.z) ?? pixel, // every camera of a meeting point sees it
      residual: point.residuals[place],
    }));
    return { x: point.x, y: point.y, clicks: shown };
  }

  /**
   * "C1 2.1 px, C3 11.8 px – check this click or the calibration of C3"
   * @param {Sighting[]} clicks
   */
  _words(clicks) {
    const named = clicks.map(({ index, residual }) => ({ name: this._scene.cameras[index].name, residual }));
    const list = named
      .map(({ name, residual }) => gettext("{name} {pixels} px", { name, pixels: residual.toFixed(1) }))
      .join(", ");
    const worst = named.reduce((one, other) => (other.residual > one.residual ? other : one));
    if (worst.residual <= DOUBTFUL) return gettext("Best place for {n} views: {list}", { n: named.length, list });
    return `${list} – ${gettext("check this click or the calibration of {name}", { name: worst.name })}`;
  }

  /** @param {Sighting[]|null} clicks */
  _show(clicks) {
    if (!clicks && !this._result) return;
    clearTimeout(this._timer);
    this._result = clicks;
    this._panes.markPeople();
    if (clicks) this._timer = setTimeout(() => this._show(null), SHOWN);
  }

  /** @param {Pane} pane */
  _items(pane) {
    const { transform, view } = pane;
    const click = this._result?.find(({ index }) => index === view.index);
    if (!click || !transform) return [];
    const { pixel, seen, residual } = click;
    const colour = residual > DOUBTFUL ? BAD : CYAN;
    const [from, to] = [pixel, seen].map(({ x, y }) => transform.toPane(x, y));
    return [
      lineItem("sighting-miss", [from, to], pane.room, colour),
      crossItem("sighting", from, colour, 5),
      readoutItem("sighting-words", pane.room, from, [gettext("{pixels} px", { pixels: residual.toFixed(1) })], colour),
    ];
  }
}
