import { element, setText } from "../../base/dom.js";
import { isWrong, LONGER } from "./marks.js";

/**
 * @typedef {import("./store.js").Store} Store
 * @typedef {import("./store.js").Report} Report
 * @typedef {import("./store.js").DeskCamera} DeskCamera
 */

/** Where the camera stands, what is to be said about it, and every point with how far it is off. */
export class Panel {
  /** @param {HTMLElement} root @param {Store} store */
  constructor(root, store) {
    this._store = store;
    this._facts = element("dl", { className: "figures" });
    this._words = element("div", { className: "stack", role: "status" });
    this._rows = element("tbody");
    const heads = ["Point", "px", "cm"].map((word, at) => element("th", { className: at ? "number" : "" }, word));
    const table = element("table", {}, element("thead", {}, element("tr", {}, ...heads)), this._rows);
    root.append(this._facts, this._words, element("div", { className: "table-scroll points" }, table));
    this._rows.addEventListener("click", (event) => {
      const row = event.target instanceof Element ? event.target.closest("tr") : null;
      if (row?.dataset.point) store.select(row.dataset.point);
    });
  }

  draw() {
    const { camera, ground } = this._store;
    this._facts.replaceChildren(...(camera ? facts(camera) : []));
    this._words.replaceChildren(...(camera ? words(camera.report, ground.doubts) : []));
    this._rows.replaceChildren(...ground.points.map(({ name }) => this._row(name)));
    this._rows.querySelector("[aria-selected=true]")?.scrollIntoView({ block: "nearest" });
  }

  /** @param {string} name */
  _row(name) {
    const { camera, selected } = this._store;
    const clicked = this._store.clickOf(name);
    const residual = clicked ? camera.report.residuals?.find((each) => each.name === name) : undefined;
    const expected = !clicked && this._store.ghostOf(name);
    const state = clicked ? (residual && !residual.used ? "left out" : "") : expected ? "expected" : "–";
    const cells = residual ? [number(residual.px, 1), number(residual.cm, 1)] : [state, ""];
    return element(
      "tr",
      {
        "data-point": name,
        "aria-selected": name === selected,
        className: `${clicked ? "clicked" : ""}${isWrong(this._store, name) ? " wrong" : ""}`,
      },
      element("td", {}, name, clicked ? element("span", { className: "muted" }, state && ` ${state}`) : null),
      ...cells.map((cell) => element("td", { className: "number" }, cell)),
    );
  }
}

/** @param {DeskCamera} camera */
function facts({ report, clicks }) {
  const { rms, centre, centre_sigma: sigma } = report;
  const clicked = fact(String(Object.keys(clicks).length), "points clicked");
  if (rms === undefined || !centre || !sigma) return [clicked];
  const spread = Math.hypot(...sigma.map((value) => value ?? 0));
  return [
    clicked,
    fact(`${rms.toFixed(2)} px`, "RMS"),
    fact(`± ${(100 * spread).toFixed(1)} cm`, "where it stands"),
    fact(`${centre[2].toFixed(2)} m`, "above the ground"),
  ];
}

/** @param {string} value @param {string} name */
function fact(value, name) {
  return element("div", {}, element("dt", {}, name), element("dd", {}, value));
}

/** @param {Report} report @param {string[]} doubts */
function words({ problem, findings = [] }, doubts) {
  const notes = [...(problem ? [problem] : []), ...findings.map(({ text }) => text), ...doubts];
  return notes.map((text) => element("p", { className: `note${problem === text ? "" : " warning"}` }, text));
}

/** @param {number|null} value @param {number} digits */
function number(value, digits) {
  return value === null ? "–" : value.toFixed(digits);
}

/** @param {HTMLElement} node @param {boolean} grid whether it is drawn */
export function legend(node, grid) {
  setText(
    node,
    `cross: clicked · dashed circle: expected here · line: residual, ${LONGER} times as long${grid ? " · thin lines: the ground" : ""}`,
  );
}
