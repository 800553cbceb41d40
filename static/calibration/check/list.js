import { element } from "../../base/dom.js";
import { summary } from "./figures.js";

/**
 * @typedef {import("./store.js").Store} Store
 * @typedef {import("./store.js").KeptPoint} KeptPoint
 * @typedef {import("./store.js").Use} Use
 * @typedef {import("./figures.js").Summary} Summary
 */

/** @type {[Use, string, string][]} use, one of them, several */
const USES = [
  ["test", "test point", "test points"],
  ["correspondence", "correspondence", "correspondences"],
];

/** Every kept point with how far its clicks are off. */
export class List {
  /** @param {HTMLElement} root @param {Store} store */
  constructor(root, store) {
    this._store = store;
    this.filter = "";
    /** @type {string|null} the point that was selected when the list was drawn last */
    this._shown = null;
    this._rows = element("tbody");
    this._empty = element("p", { className: "muted small" });
    const heads = ["Point", "kept as", "views", "worst px"];
    const cells = heads.map((word, at) => element("th", { className: at > 1 ? "number" : "" }, word));
    this._table = element("table", {}, element("thead", {}, element("tr", {}, ...cells)), this._rows);
    root.append(element("div", { className: "table-scroll points" }, this._table), this._empty);
    this._rows.addEventListener("click", (event) => {
      const row = event.target instanceof Element ? event.target.closest("tr") : null;
      if (row?.dataset.point) store.select(row.dataset.point === store.selected ? null : row.dataset.point);
    });
  }

  draw() {
    const { kept, selected } = this._store;
    const listed = kept.filter(({ use }) => !this.filter || use === this.filter);
    this._table.hidden = listed.length === 0;
    this._empty.hidden = listed.length > 0;
    this._empty.textContent = kept.length
      ? "None of this kind."
      : "None yet: click something in two views, then T or K.";
    this._rows.replaceChildren(...listed.map((point) => this._row(point, point.name === selected)));
    if (selected !== this._shown)
      this._rows.querySelector("[aria-selected=true]")?.scrollIntoView({ block: "nearest" });
    this._shown = selected;
  }

  /** @param {KeptPoint} point @param {boolean} selected */
  _row(point, selected) {
    const { spot, views } = this._store.figuresOf(point.clicks);
    const all = Object.values(views);
    const off = all.some(({ doubtful }) => doubtful);
    const worst = spot ? Math.max(...all.map(({ residual }) => residual)).toFixed(1) : "–";
    const use = USES.find(([name]) => name === point.use)?.[1] ?? "";
    return element(
      "tr",
      { "data-point": point.name, "aria-selected": selected, className: `clicked${off ? " wrong" : ""}` },
      element("td", {}, point.name),
      element("td", {}, use),
      element("td", { className: "number" }, String(Object.keys(point.clicks).length)),
      element("td", { className: "number" }, off ? `■ ${worst}` : worst),
    );
  }
}

/** What all kept points of each use tell, camera by camera. @param {HTMLElement} root @param {Store} store */
export function drawSummary(root, store) {
  const found = USES.map(([use]) =>
    summary(store.kept.filter((point) => point.use === use).map(({ clicks }) => store.figuresOf(clicks))),
  );
  const heads = element("tr", {}, element("th", {}, "Camera"), ...USES.map(([, , many]) => number("th", many)));
  const rows = store.all.map(({ name }) =>
    element("tr", {}, element("td", {}, name), ...found.map(({ byCamera }) => number("td", pixels(byCamera[name])))),
  );
  const whole = element("tr", {}, element("th", {}, "All"), ...found.map((each) => number("th", words(each))));
  root.replaceChildren(element("table", {}, element("thead", {}, heads), element("tbody", {}, ...rows, whole)));
}

/** @param {Summary} summary */
function words({ points, clicks, median, p95, off }) {
  if (median === null || p95 === null) return "none";
  const told = `${points} with ${clicks} clicks: median ${pixels(median)}, 95 % within ${pixels(p95)}`;
  return off ? `${told}; ${off} marked` : told;
}

/** @param {number|undefined} value */
function pixels(value) {
  return value === undefined ? "–" : `${value.toFixed(2)} px`;
}

/** @param {"th"|"td"} tag @param {string} text */
function number(tag, text) {
  return element(tag, { className: "number" }, text);
}
