import { fetched } from "../../base/lazy.js";
import { gettext } from "../../base/messages.js";
import { groundLine } from "../../geometry/ground.js";
import { annotation } from "../../truth/annotation.js";
import { spotOn, spotWords } from "../../truth/ground_point.js";
import { crossItem, lineItem, readoutItem } from "../../views/hints_on_ground.js";
import { CYAN, LOOKS } from "../../views/styles.js";

const AGAIN = 10_000; // ms until a part that did not arrive is asked for again
const NOBODY = -1; // the number of somebody new, who has none yet
const SILENT = { say() {} }; // a pointer that moves asks for nothing, so nobody is told what did not arrive

/**
 * What a click would place, before anything is placed: the cylinder in every view, the line on the ground
 * along which the view's ray runs, the position in metres, and what speaks against it.
 * @typedef {import("../../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../../truth/ground_point.js").GroundPoint} GroundPoint
 * @typedef {import("../../truth/ground_point.js").XY} XY
 * @typedef {import("../../views/pane.js").Pane} Pane
 * @typedef {import("../../views/transform.js").Transform} Transform
 * @typedef {(typeof LOOKS)[keyof typeof LOOKS]} Look
 * @typedef {typeof import("../../truth/uncertainty.js")} DoubtPart
 * @typedef {{metres: number, settles: Pane|null}} Doubt
 * @typedef {{annotation: Annotation|null, look: Look}} Figure null: there is no place for one
 * @typedef {object} Hovered
 * @property {Pane} pane
 * @property {XY} at CSS pixels of the pane
 * @property {GroundPoint} spot
 * @property {Annotation|null} over who is under the pointer
 * @property {string[]} words
 * @typedef {Hovered & Figure} Shown
 */
export class Ghost {
  /**
   * @param {object} parts
   * @param {import("../../truth/scene.js").Scene} parts.scene
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {import("../../views/panes.js").Panes} parts.panes
   * @param {import("./guard.js").Guard} parts.guard
   * @param {import("../settings.js").Settings} parts.settings
   * @param {import("./heads.js").Heads} parts.heads
   */
  constructor({ scene, store, panes, guard, settings, heads }) {
    this._scene = scene;
    this._store = store;
    this._panes = panes;
    this._guard = guard;
    this._settings = settings;
    this._heads = heads;
    /** @type {Shown|null} */
    this._shown = null;
    panes.addExtra(/** @param {Pane} pane */ (pane) => this._items(pane));
    /** @type {DoubtPart["uncertaintyAt"]|null} fetched when the pointer comes first */
    this._doubtAt = null;
    /** @type {() => Promise<DoubtPart|null>} */
    this._doubtPart = fetched(SILENT, import.meta.resolve("../../truth/uncertainty.js"));
    this._fetching = false;
    store.on("frame", () => this.hide());
    heads.on("change", () => this.hide());
    settings.watch("ghost", (on) => on || this.hide());
  }

  /**
   * @param {Pane} pane @param {XY} at CSS pixels of the pane
   * @param {Annotation|null} over who is under the pointer: a click would select them, a right click still moves
   */
  hover(pane, at, over) {
    const selected = this._store.selected() ?? null;
    if (!this._settings.get("ghost") || !this._canPlace(pane, at) || (over && !selected)) return this.hide();
    const moved = over ? selected : null;
    const spot = spotOn(this._scene, this._store, this._heads.ground(pane, at, moved), moved?.person ?? null);
    if (spot.position !== null && this._isShown(pane, spot, over)) return;
    const doubt = this._doubt(pane, spot, moved);
    this._shown = { pane, at, spot, over, words: this._words(pane, spot, doubt), ...this._figure(spot, moved) };
    this._point(doubt.settles);
    this._panes.markPeople();
  }

  hide() {
    if (!this._shown) return;
    this._shown = null;
    this._point(null);
    this._panes.markPeople();
  }

  /** @param {Pane} pane @param {GroundPoint} spot @param {Doubt} doubt */
  _words(pane, spot, { metres, settles }) {
    const words = spotWords(this._scene, spot, pane.view.byTable);
    if (this._heads.active) words.push(gettext("the top of the head is here"));
    if (settles)
      words.push(
        gettext("± {cm} cm: Alt + click in {view}, too", { cm: Math.round(100 * metres), view: settles.view.title }),
      );
    return words;
  }

  /**
   * How far a click here can be off, and the pane where one more would settle it.
   * @param {Pane} pane @param {GroundPoint} spot @param {Annotation|null} moved @returns {Doubt}
   */
  _doubt(pane, spot, moved) {
    if (!this._doubtAt) this._fetchDoubt();
    if (!this._doubtAt || spot.position === null || !spot.ground) return { metres: 0, settles: null };
    return this._doubtAt(this._scene, this._panes.shown, pane, spot.ground, this._heads.height(pane, moved));
  }

  async _fetchDoubt() {
    if (this._fetching) return;
    this._fetching = true;
    const part = await this._doubtPart();
    if (!part) return void setTimeout(() => (this._fetching = false), AGAIN);
    this._doubtAt = part.uncertaintyAt;
    const shown = this._shown;
    this._shown = null;
    if (shown) this.hover(shown.pane, shown.at, shown.over);
  }

  /**
   * The pane that would settle it is framed.
   * @param {Pane|null} settling
   */
  _point(settling) {
    for (const { element } of this._panes.all) element.toggleAttribute("data-settles", element === settling?.element);
  }

  /** @param {Pane} pane @param {XY} at */
  _canPlace(pane, at) {
    if (!this._guard.editable || !pane.transform || this._heads.refusal(pane)) return false;
    const { x, y } = pane.transform.toSource(at.x, at.y);
    return x >= 0 && y >= 0 && x < pane.view.size.width && y < pane.view.size.height;
  }

  /** @param {Pane} pane @param {GroundPoint} spot @param {Annotation|null} over */
  _isShown(pane, { position, problem }, over) {
    const shown = this._shown;
    return (
      shown?.pane === pane && shown.over === over && shown.spot.position === position && shown.spot.problem === problem
    );
  }

  /**
   * A new person has the usual size, one who is moved keeps their own.
   * @param {GroundPoint} spot @param {Annotation|null} moved @returns {Figure}
   */
  _figure({ position, problem }, moved) {
    if (position === null) return { annotation: null, look: LOOKS.refused };
    const { height, radius } = moved ?? { height: null, radius: null };
    const figure = annotation({ person: NOBODY, position, height, radius });
    return { annotation: figure, look: problem ? LOOKS.refused : LOOKS.ghost };
  }

  /** @param {Pane} pane */
  _items(pane) {
    const [shown, { transform }] = [this._shown, pane];
    if (!shown || !transform) return [];
    return [
      ...this._rayItems(pane, transform, shown),
      ...this._figureItems(pane, transform, shown),
      ...this._readoutItems(pane, transform, shown),
    ];
  }

  /**
   * Without a number above: nobody new has one, and who is moved shows it already.
   * @param {Pane} pane @param {Transform} transform @param {Shown} shown
   */
  _figureItems(pane, transform, { annotation: figure, look, spot }) {
    if (figure) {
      if (!pane.view.box(figure)) return [];
      const options = { ...this._panes.options, labelOpacity: 0 };
      return [{ ...pane.view.item(figure, look, transform, options), id: "ghost" }];
    }
    const point = spot.ground && pane.view.point(spot.ground);
    return point ? [crossItem("ghost", transform.toPane(point.x, point.y), look.colour)] : [];
  }

  /**
   * How deep a click lands depends on its height in the picture: along this line it can be wrong most.
   * @param {Pane} pane @param {Transform} transform @param {Shown} shown
   */
  _rayItems(pane, transform, { pane: origin, spot }) {
    const { index } = origin.view;
    if (index === null || !spot.ground || pane === origin) return [];
    const [x1, y1] = this._scene.cameras[index].centre;
    return this._groundLines(pane, { x: x1, y: y1 }, spot.ground).map((line, place) =>
      lineItem(
        `ghost-ray-${place}`,
        line.map(({ x, y }) => transform.toPane(x, y)),
        pane.room,
        CYAN,
        [5, 4],
      ),
    );
  }

  /** @param {Pane} pane @param {XY} from metres @param {XY} to @returns {XY[][]} */
  _groundLines({ view }, from, to) {
    if (view.index !== null) return groundLine(this._scene.cameras[view.index], from.x, from.y, to.x, to.y);
    const [start, end] = [view.point(from), view.point(to)];
    return start && end ? [[start, end]] : [];
  }

  /**
   * At the pointer and, from above, at the place on the map.
   * @param {Pane} pane @param {Transform} transform @param {Shown} shown
   */
  _readoutItems(pane, transform, { pane: origin, at, spot, words, look }) {
    if (pane === origin) return [readoutItem("ghost-readout", pane.room, at, words, look.colour)];
    const point = pane.view.index === null && spot.ground && pane.view.point(spot.ground);
    if (!point) return [];
    return [readoutItem("ghost-readout", pane.room, transform.toPane(point.x, point.y), words, look.colour)];
  }
}
