/**
 * Equal panes as large as the room allows. Columns are chosen so that pictures come out largest; when the
 * last row has a cell to spare, the side panel takes it, otherwise the panel gets a column of its own.
 * @typedef {import("./pane.js").Pane} Pane
 * @typedef {import("./regions.js").Size} Size
 * @typedef {"cell"|"column"|"none"} PanelPlace
 * @typedef {{columns: number, rows: number, panel: PanelPlace} & Size} Arrangement size of one pane
 * @typedef {{columns: number, rows: number, largeColumns: number, largeRows: number}} Around cells of the grid, and how
 *   many of them the large one takes
 */
import { unit } from "../base/scale.js";

const GAP = 2;
const PANEL = 248; // units, a panel column
const SMALL_COUNT = 2; // how much their width is worth against the large one's: they are to be read, too
const PANEL_CELL = 300; // units, the smallest cell that can hold the panel

/**
 * Pure.
 * @param {number} count at least one @param {Size} room @param {number} aspect @param {boolean} [panelShown]
 * @returns {Arrangement}
 */
export function arrange(count, room, aspect, panelShown = true) {
  /** @type {(Arrangement & {picture: number})|null} */
  let best = null;
  /** @type {PanelPlace[]} */
  const places = panelShown ? ["cell", "column"] : ["none"];
  for (let columns = 1; columns <= count; columns += 1) {
    const rows = Math.ceil(count / columns);
    const spare = columns * rows - count;
    for (const panel of places) {
      const inner = panel === "column" ? room.width - PANEL - GAP : room.width;
      const width = (inner - (columns - 1) * GAP) / columns;
      const height = (room.height - (rows - 1) * GAP) / rows;
      if (panel === "cell" && (spare === 0 || width < PANEL_CELL)) continue;
      const picture = Math.min(width, height * aspect);
      if (!best || picture > best.picture + 0.5) best = { columns, rows, panel, width, height, picture };
    }
  }
  if (!best) throw new RangeError("there is no pane to arrange");
  return best;
}

/**
 * One large pane in the upper left, the others beside and below it. Pure.
 * @param {number} count at least two @param {Size} room @param {number} aspect
 * @returns {Around}
 */
export function arrangeAround(count, room, aspect) {
  const others = count - 1;
  const width = room.width - PANEL - GAP;
  /** @type {(Around & {worth: number})|null} */
  let best = null;
  for (let columns = 2; columns <= count; columns += 1) {
    for (let rows = 1; rows <= count; rows += 1) {
      for (const largeRows of [rows - 1, rows]) {
        const cells = columns * rows - (columns - 1) * largeRows;
        if (largeRows === 0 || cells < others) continue;
        const [small, high] = [width / columns, room.height / rows];
        const large = Math.min(small * (columns - 1), high * largeRows * aspect);
        const worth = large + SMALL_COUNT * Math.min(small, high * aspect);
        if (!best || worth > best.worth + 0.5) best = { columns, rows, largeColumns: columns - 1, largeRows, worth };
      }
    }
  }
  if (!best) throw new RangeError("there is no pane to arrange");
  return best;
}

/** Keeps a grid of panes arranged while its room changes. */
export class Layout {
  /**
   * @param {HTMLElement} container @param {import("./panes.js").AnyPanes} panes
   * @param {HTMLElement} panel @param {number} aspect of the pictures
   */
  constructor(container, panes, panel, aspect) {
    this._container = container;
    this._panes = panes;
    this._panel = panel;
    this._aspect = aspect;
    /** @type {Pane|null} */
    this._large = null;
    container.append(panes.element, panel);
    this._observer = new ResizeObserver(() => this.update());
    this._observer.observe(container);
    this.update();
  }

  /** @param {Pane|null} pane the one that is large; null: all alike */
  setLarge(pane) {
    this._large = pane;
    this.update();
  }

  get large() {
    return this._large;
  }

  update() {
    const [width, height] = [this._container.clientWidth / unit(), this._container.clientHeight / unit()];
    if (!width || !height) return;
    const { shown, all } = this._panes;
    const { columns, rows, panel, largeColumns, largeRows } = this._arrangement(shown.length, { width, height });
    const { style } = this._panes.element;
    style.setProperty("--columns", String(columns));
    style.setProperty("--rows", String(rows));
    style.setProperty("--large-columns", String(largeColumns));
    style.setProperty("--large-rows", String(largeRows));
    for (const pane of all) pane.element.classList.toggle("large", pane === this._large);
    this._container.dataset.panel = panel;
    const parent = panel === "cell" ? this._panes.element : this._container;
    if (this._panel.parentElement !== parent) parent.append(this._panel);
  }

  /** @param {number} count @param {Size} room @returns {Around & {panel: PanelPlace}} */
  _arrangement(count, room) {
    if (this._large) return { ...arrangeAround(count, room, this._aspect), panel: "column" };
    return { ...arrange(count, room, this._aspect), largeColumns: 1, largeRows: 1 };
  }
}
