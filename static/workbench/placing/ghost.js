import { fetched } from "../../base/lazy.js";
import { gettext } from "../../base/messages.js";
import { groundLine } from "../../geometry/ground.js";
import { annotation } from "../../truth/annotation.js";
import { spotOn, spotWords } from "../../truth/ground_point.js";
import { crossItem, lineItem, readoutItem } from "../../views/hints_on_ground.js";
import { CYAN, LOOKS } from "../../views/styles.js";

const AGAIN = 10_000; // ms until a part that did not arrive is asked for again
const SILENT = { say() {} }; // a pointer that moves asks for nothing, so nobody is told what did not arrive

/**
 * What a click would place, before anything is placed: the cylinder in every view, the line on the ground
 * along which the view's ray runs, the position in metres, and what speaks against it.
 */
export class Ghost {
  constructor({ scene, store, panes, guard, settings, heads }) {
    Object.assign(this, {
      _scene: scene,
      _store: store,
      _panes: panes,
      _guard: guard,
      _settings: settings,
      _heads: heads,
    });
    this._shown = null; // {pane, at, spot, words, annotation, look}
    panes.addExtra((pane) => this._items(pane));
    this._doubtAt = null; // fetched when the pointer comes first
    this._doubtPart = fetched(SILENT, import.meta.resolve("../../truth/uncertainty.js"));
    this._fetching = false;
    store.on("frame", () => this.hide());
    heads.on("change", () => this.hide());
    settings.watch("ghost", (on) => on || this.hide());
  }

  /** @param {object|null} over who is under the pointer: a click would select them, a right click still moves */
  hover(pane, at, over) {
    const selected = this._store.selected();
    if (!this._settings.get("ghost") || !this._canPlace(pane, at) || (over && !selected)) return this.hide();
    const moved = over && selected;
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

  _words(pane, spot, { metres, settles }) {
    const words = spotWords(this._scene, spot, pane.view.byTable);
    if (this._heads.active) words.push(gettext("the top of the head is here"));
    if (settles)
      words.push(
        gettext("± {cm} cm: Alt + click in {view}, too", { cm: Math.round(100 * metres), view: settles.view.title }),
      );
    return words;
  }

  /** How far a click here can be off, and the pane where one more would settle it. */
  _doubt(pane, spot, moved) {
    if (!this._doubtAt) this._fetchDoubt();
    if (!this._doubtAt || spot.position === null) return { metres: 0, settles: null };
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

  /** The pane that would settle it is framed. */
  _point(settling) {
    for (const { element } of this._panes.all) element.toggleAttribute("data-settles", element === settling?.element);
  }

  _canPlace(pane, at) {
    if (!this._guard.editable || !pane.transform || this._heads.refusal(pane)) return false;
    const { x, y } = pane.transform.toSource(at.x, at.y);
    return x >= 0 && y >= 0 && x < pane.view.size.width && y < pane.view.size.height;
  }

  _isShown(pane, { position, problem }, over) {
    const shown = this._shown;
    return (
      shown?.pane === pane && shown.over === over && shown.spot.position === position && shown.spot.problem === problem
    );
  }

  /** A new person has the usual size, one who is moved keeps their own. */
  _figure({ position, problem }, moved) {
    if (position === null) return { annotation: null, look: LOOKS.refused };
    const { height, radius } = moved || { height: null, radius: null };
    const figure = annotation({ person: null, position, height, radius });
    return { annotation: figure, look: problem ? LOOKS.refused : LOOKS.ghost };
  }

  _items(pane) {
    if (!this._shown || !pane.transform) return [];
    return [...this._rayItems(pane), ...this._figureItems(pane), ...this._readoutItems(pane)];
  }

  _figureItems(pane) {
    const { annotation: figure, look, spot } = this._shown;
    if (figure) {
      if (!pane.view.box(figure)) return [];
      return [{ ...pane.view.item(figure, look, pane.transform, this._panes.options), id: "ghost" }];
    }
    const point = spot.ground && pane.view.point(spot.ground);
    return point ? [crossItem("ghost", pane.transform.toPane(point.x, point.y), look.colour)] : [];
  }

  /** How deep a click lands depends on its height in the picture: along this line it can be wrong most. */
  _rayItems(pane) {
    const { pane: origin, spot } = this._shown;
    const camera = this._scene.cameras[origin.view.index];
    if (!camera || !spot.ground || pane === origin) return [];
    const [[x1, y1], { x: x2, y: y2 }] = [camera.centre, spot.ground];
    return this._groundLines(pane, x1, y1, x2, y2).map((line, index) =>
      lineItem(
        `ghost-ray-${index}`,
        line.map(({ x, y }) => pane.transform.toPane(x, y)),
        pane.room,
        CYAN,
        [5, 4],
      ),
    );
  }

  _groundLines(pane, x1, y1, x2, y2) {
    if (pane.view.index === null) return [[pane.view.point({ x: x1, y: y1 }), pane.view.point({ x: x2, y: y2 })]];
    return groundLine(this._scene.cameras[pane.view.index], x1, y1, x2, y2);
  }

  /** At the pointer and, from above, at the place on the map. */
  _readoutItems(pane) {
    const { pane: origin, at, spot, words, look } = this._shown;
    if (pane === origin) return [readoutItem("ghost-readout", pane.room, at, words, look.colour)];
    if (pane.view.index !== null || !spot.ground) return [];
    const { x, y } = pane.view.point(spot.ground);
    return [readoutItem("ghost-readout", pane.room, pane.transform.toPane(x, y), words, look.colour)];
  }
}
