/**
 * Equal panes as large as the room allows. Columns are chosen so that pictures come out largest; when the
 * last row has a cell to spare, the side panel takes it, otherwise the panel gets a column of its own.
 */
const GAP = 2;
const PANEL = 248; // px, a panel column
const PANEL_CELL = 300; // px, the smallest cell that can hold the panel

/** Pure. @returns {{columns, rows, panel: "cell"|"column", width, height}} of one pane */
export function arrange(count, room, aspect, panelShown = true) {
  let best = null;
  for (let columns = 1; columns <= count; columns += 1) {
    const rows = Math.ceil(count / columns);
    const spare = columns * rows - count;
    for (const panel of panelShown ? ["cell", "column"] : ["none"]) {
      const inner = panel === "column" ? room.width - PANEL - GAP : room.width;
      const width = (inner - (columns - 1) * GAP) / columns;
      const height = (room.height - (rows - 1) * GAP) / rows;
      if (panel === "cell" && (spare === 0 || width < PANEL_CELL)) continue;
      const picture = Math.min(width, height * aspect);
      if (!best || picture > best.picture + 0.5) best = { columns, rows, panel, width, height, picture };
    }
  }
  return best;
}

/** Keeps a grid of panes arranged while its room changes. */
export class Layout {
  constructor(container, panes, panel, aspect) {
    this._container = container;
    this._panes = panes;
    this._panel = panel;
    this._aspect = aspect;
    container.append(panes.element, panel);
    this._observer = new ResizeObserver(() => this.update());
    this._observer.observe(container);
    this.update();
  }

  update() {
    const { clientWidth: width, clientHeight: height } = this._container;
    if (!width || !height) return;
    const { columns, rows, panel } = arrange(this._panes.all.length, { width, height }, this._aspect);
    this._panes.element.style.setProperty("--columns", columns);
    this._panes.element.style.setProperty("--rows", rows);
    this._container.dataset.panel = panel;
    const parent = panel === "cell" ? this._panes.element : this._container;
    if (this._panel.parentElement !== parent) parent.append(this._panel);
  }
}
