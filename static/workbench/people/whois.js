import { VALIDATED } from "../../truth/annotation.js";
import { paintCrop } from "../../views/crop_paint.js";
import { CYAN, HALO } from "../../views/styles.js";

const SHARE = 0.38; // of a pane's height
const TALLEST = 150; // CSS pixels
const SLIM = 0.5; // width of a crop, in heights
const EDGE = 6;

/**
 * Close up one sees legs. In a corner of every view stands whom they belong to: the whole person where they were
 * validated last, the whole person here, and the number.
 */
export class WhoIs {
  constructor({ scene, store, images, panes }) {
    Object.assign(this, { _scene: scene, _store: store, _images: images, _panes: panes });
    panes.addExtra((pane) => this._items(pane));
    images.on("picture", () => this._shows && panes.markPeople());
    panes.markPeople();
  }

  get _shows() {
    return this._panes.closeUp && this._panes.zoomed && this._store.selected() !== undefined;
  }

  _items(pane) {
    if (!this._shows || pane.view.index === null || !pane.view.box(this._store.selected())) return [];
    const shown = [this._lastSeen(), { number: this._store.current, one: this._store.selected() }].filter(Boolean);
    const height = Math.min(TALLEST, SHARE * pane.room.height);
    const width = SLIM * height;
    const left = pane.room.width - EDGE - shown.length * width;
    const cells = shown.map(({ number, one }, index) => ({
      cell: {
        x: left + index * width,
        y: EDGE,
        width: width - 2,
        height,
        view: pane.view.index,
        picture: this._picture(number, pane.view.index),
      },
      one,
    }));
    const pictures = cells.map(({ cell }) => cell.picture?.width ?? 0);
    return [
      {
        id: "whois",
        what: this._store.selected(),
        look: `${shown.map(({ number }) => number)} ${pictures} ${Math.round(left)} ${Math.round(height)}`,
        bounds: { xmin: left - 2, ymin: EDGE - 2, xmax: pane.room.width, ymax: EDGE + height + 2 },
        draw: (ctx) => this._draw(ctx, cells, left, pane.room.width - EDGE - left, height),
      },
    ];
  }

  _draw(ctx, cells, left, width, height) {
    ctx.fillStyle = HALO;
    ctx.fillRect(left - 2, EDGE - 2, width + 2, height + 4);
    for (const { cell, one } of cells) paintCrop(ctx, this._scene, cell, one, true);
    const number = String(this._store.selection);
    ctx.font = "700 13px system-ui, 'DejaVu Sans', sans-serif";
    ctx.textAlign = "left";
    ctx.textBaseline = "middle";
    ctx.fillStyle = HALO;
    ctx.fillRect(left, EDGE, 9 * number.length + 8, 18);
    ctx.fillStyle = CYAN;
    ctx.fillText(number, left + 4, EDGE + 9.5);
  }

  /** The nearest frame, earlier ones first, in which somebody has looked at the person. */
  _lastSeen() {
    const { numbers, current, selection } = this._store;
    const index = numbers.indexOf(current);
    const known = (number) => this._store.person(selection, number)?.state === VALIDATED;
    const number = numbers.slice(0, index).findLast(known) ?? numbers.slice(index + 1).find(known);
    return number === undefined ? null : { number, one: this._store.person(selection, number) };
  }

  _picture(number, view) {
    return this._images.peek(number, view, "full") ?? this._images.get(number, view, "light").bitmap;
  }
}
