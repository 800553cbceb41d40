import { groundLine } from "../geometry/ground.js";
import { annotation } from "./annotation.js";
import { crossItem, lineItem, readoutItem } from "./hints_on_ground.js";
import { CYAN, LOOKS } from "./looks.js";
import { spotOn, spotWords } from "./spot.js";

/**
 * What a click would place, before anything is placed: the cylinder in every view, the line on the ground
 * along which the view's ray runs, the position in metres, and what speaks against it.
 */
export class Ghost {
  constructor({ scene, store, panes, guard, settings }) {
    Object.assign(this, { _scene: scene, _store: store, _panes: panes, _guard: guard, _settings: settings });
    this._shown = null; // {pane, at, spot, words, annotation, look}
    panes.addExtra((pane) => this._items(pane));
    store.on("frame", () => this.hide());
    settings.watch("ghost", (on) => on || this.hide());
  }

  /** @param {object|null} over who is under the pointer: a click would select them, a right click still moves */
  hover(pane, at, over) {
    const selected = this._store.selected();
    if (!this._settings.get("ghost") || !this._canPlace(pane, at) || (over && !selected)) return this.hide();
    const ground = pane.view.ground(pane.transform.toSource(at.x, at.y));
    const spot = spotOn(this._scene, this._store, ground, over ? selected.person : null);
    if (spot.position !== null && this._isShown(pane, spot, over)) return;
    this._shown = { pane, at, spot, over, words: spotWords(this._scene, spot), ...this._figure(spot, over && selected) };
    this._panes.markPeople();
  }

  hide() {
    if (!this._shown) return;
    this._shown = null;
    this._panes.markPeople();
  }

  _canPlace(pane, at) {
    if (!this._guard.editable || !pane.transform) return false;
    const { x, y } = pane.transform.toSource(at.x, at.y);
    return x >= 0 && y >= 0 && x < pane.view.size.width && y < pane.view.size.height;
  }

  _isShown(pane, { position, problem }, over) {
    const shown = this._shown;
    return shown?.pane === pane && shown.over === over && shown.spot.position === position && shown.spot.problem === problem;
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
