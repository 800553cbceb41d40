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
 */
export class MultiViewClick {
  constructor({ scene, store, panes, guard }) {
    Object.assign(this, { _scene: scene, _store: store, _panes: panes, _guard: guard });
    this._annotation = null; // the person as the clicks have put them
    this._frame = null;
    this._clicks = new Map(); // camera index → pixel {x, y}, and z: how high above the feet
    this._result = null; // {clicks: {index, pixel, seen, residual}[]}, shown for a while
    this._timer = null;
    panes.addExtra((pane) => this._items(pane));
    store.on("change", () => this._result && !this._valid() && this._show(null));
    store.on("frame", () => this._show(null));
    store.on("selection", () => this._show(null));
  }

  /** A first click has put the selected person where it is. */
  begin(pane, pixel) {
    this._clicks = new Map();
    this._remember(pane, pixel);
    this._show(null);
  }

  /**
   * One more click on the feet of the selected person, if there was one in another view before.
   * @param {{x, y, z}} pixel of the view's picture, and metres above the ground of what it shows
   * @param {(position: number) => boolean} move puts the person there if possible
   * @returns {boolean} false: this is the first click
   */
  add(pane, pixel, event, move) {
    if (!this._valid() || [...this._clicks.keys()].every((index) => index === pane.view.index)) return false;
    const clicks = new Map(this._clicks).set(pane.view.index, pixel);
    const found = this._meeting(clicks);
    const position = found && this._scene.positionAt(found);
    if (position === null) {
      this._guard.say(event, gettext("These clicks do not meet in the ground area: is it the same person?"));
      return true;
    }
    if (!move(position)) return true;
    this._remember(pane, pixel);
    this._show(found.clicks);
    this._guard.say(event, this._words(found.clicks));
    return true;
  }

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

  _meeting(clicks) {
    const entries = [...clicks];
    const { cameras } = this._scene;
    const point = groundPoint(entries.map(([index, { x, y, z }]) => ({ camera: cameras[index], u: x, v: y, z })));
    if (!point) return null;
    const shown = entries.map(([index, pixel], place) => ({
      index,
      pixel,
      seen: this._scene.toImage(index, point, pixel.z),
      residual: point.residuals[place],
    }));
    return { x: point.x, y: point.y, clicks: shown };
  }

  /** "C1 2.1 px, C3 11.8 px – check this click or the calibration of C3" */
  _words(clicks) {
    const named = clicks.map(({ index, residual }) => ({ name: this._scene.cameras[index].name, residual }));
    const list = named
      .map(({ name, residual }) => gettext("{name} {pixels} px", { name, pixels: residual.toFixed(1) }))
      .join(", ");
    const worst = named.reduce((one, other) => (other.residual > one.residual ? other : one));
    if (worst.residual <= DOUBTFUL) return gettext("Best place for {n} views: {list}", { n: named.length, list });
    return `${list} – ${gettext("check this click or the calibration of {name}", { name: worst.name })}`;
  }

  _show(clicks) {
    if (!clicks && !this._result) return;
    clearTimeout(this._timer);
    this._result = clicks;
    this._panes.markPeople();
    if (clicks) this._timer = setTimeout(() => this._show(null), SHOWN);
  }

  _items(pane) {
    const click = this._result?.find(({ index }) => index === pane.view.index);
    if (!click || !pane.transform) return [];
    const { pixel, seen, residual } = click;
    const colour = residual > DOUBTFUL ? BAD : CYAN;
    const [from, to] = [pixel, seen].map(({ x, y }) => pane.transform.toPane(x, y));
    return [
      lineItem("sighting-miss", [from, to], pane.room, colour),
      crossItem("sighting", from, colour, 5),
      readoutItem("sighting-words", pane.room, from, [gettext("{pixels} px", { pixels: residual.toFixed(1) })], colour),
    ];
  }
}
