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
 * @typedef {import("../../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../../views/pane.js").Pane} Pane
 * @typedef {{number: number, one: Annotation}} Seen somebody in a frame
 * @typedef {{x: number, y: number, width: number, height: number, view: number, picture: ImageBitmap|null}} Cell
 */
export class WhoIs {
  /**
   * @param {object} parts
   * @param {import("../../truth/scene.js").Scene} parts.scene
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {import("../../views/images.js").Images} parts.images
   * @param {import("../../views/panes.js").Panes} parts.panes
   */
  constructor({ scene, store, images, panes }) {
    this._scene = scene;
    this._store = store;
    this._images = images;
    this._panes = panes;
    panes.addExtra(/** @param {Pane} pane */ (pane) => this._items(pane));
    images.on("picture", () => this._shows && panes.markPeople());
    panes.markPeople();
  }

  get _shows() {
    return this._whom !== null;
  }

  /** Who is selected, close up. */
  get _whom() {
    return this._panes.closeUp && this._panes.zoomed ? (this._store.selected() ?? null) : null;
  }

  /** @param {Pane} pane */
  _items(pane) {
    const [whom, { index }] = [this._whom, pane.view];
    if (!whom || index === null || !pane.view.box(whom)) return [];
    const before = this._lastSeen(whom.person);
    const shown = [...(before ? [before] : []), { number: this._store.current, one: whom }];
    const height = Math.min(TALLEST, SHARE * pane.room.height);
    const width = SLIM * height;
    const left = pane.room.width - EDGE - shown.length * width;
    const cells = shown.map(({ number, one }, place) => ({
      cell: {
        x: left + place * width,
        y: EDGE,
        width: width - 2,
        height,
        view: index,
        picture: this._picture(number, index),
      },
      one,
    }));
    const pictures = cells.map(({ cell }) => cell.picture?.width ?? 0);
    return [
      {
        id: "whois",
        what: whom,
        look: `${shown.map(({ number }) => number)} ${pictures} ${Math.round(left)} ${Math.round(height)}`,
        bounds: { xmin: left - 2, ymin: EDGE - 2, xmax: pane.room.width, ymax: EDGE + height + 2 },
        /** @param {CanvasRenderingContext2D} ctx */
        draw: (ctx) => this._draw(ctx, cells, left, pane.room.width - EDGE - left, height),
      },
    ];
  }

  /**
   * @param {CanvasRenderingContext2D} ctx @param {{cell: Cell, one: Annotation}[]} cells
   * @param {number} left @param {number} width @param {number} height
   */
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

  /**
   * The nearest frame, earlier ones first, in which somebody has looked at the person.
   * @param {number} person @returns {Seen|null}
   */
  _lastSeen(person) {
    const { numbers, current } = this._store;
    const index = numbers.indexOf(current);
    /** @param {number} number */
    const known = (number) => this._store.person(person, number)?.state === VALIDATED;
    const number = numbers.slice(0, index).findLast(known) ?? numbers.slice(index + 1).find(known);
    return number === undefined ? null : { number, one: this._store.marked(person, number) };
  }

  /** @param {number} number @param {number} view @returns {ImageBitmap|null} */
  _picture(number, view) {
    return this._images.peek(number, view, "full") ?? this._images.get(number, view, "light").bitmap;
  }
}
