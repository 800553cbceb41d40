import { element } from "../../base/dom.js";

const FLAT = 5; // degrees: rays that cross at less tell little along themselves

/**
 * @typedef {import("./store.js").Store} Store
 * @typedef {import("../../geometry/spatial.js").Spot} Spot
 */

/** Where the thing is, ± what, and what is to be said about its clicks. */
export class Panel {
  /** @param {HTMLElement} root @param {Store} store */
  constructor(root, store) {
    this._store = store;
    this._facts = element("dl", { className: "figures" });
    this._words = element("div", { className: "stack", role: "status" });
    root.append(this._facts, this._words);
  }

  draw() {
    const { spot } = this._store.figures;
    this._facts.replaceChildren(...(spot ? facts(spot) : []));
    this._words.replaceChildren(...words(this._store).map((text) => element("p", { className: "note warning" }, text)));
  }
}

/** @param {Spot} spot */
function facts({ point: [x, y, z], sigmas, groundSigma, angle }) {
  return [
    fact(`${x.toFixed(3)} m`, "X", "x"),
    fact(`${y.toFixed(3)} m`, "Y", "y"),
    fact(`${z.toFixed(3)} m`, "height", "z"),
    fact(`± ${centimetres(groundSigma)}`, "on the ground", "ground-sigma"),
    fact(`± ${centimetres(sigmas[2])}`, "height", "z-sigma"),
    fact(`${angle.toFixed(0)}°`, "rays cross at", "angle"),
  ];
}

/** @param {string} value @param {string} name @param {string} what */
function fact(value, name, what) {
  return element("div", {}, element("dt", {}, name), element("dd", { "data-fact": what }, value));
}

/** @param {number} metres */
function centimetres(metres) {
  return `${(100 * metres).toFixed(1)} cm`;
}

/** @param {Store} store @returns {string[]} */
function words({ figures, clicks, cameras }) {
  const { spot, views } = figures;
  const used = Object.keys(clicks).filter((name) => cameras.has(name));
  const out = Object.keys(clicks).filter((name) => !cameras.has(name));
  const told = out.length ? [`${out.join(", ")}: not calibrated, so the click there tells nothing.`] : [];
  if (!spot) return used.length > 1 ? [...told, "These clicks meet nowhere that the views show."] : told;
  const off = used.filter((name) => views[name]?.doubtful);
  if (off.length === 2 && used.length === 2)
    told.push("The two clicks contradict each other: one shows another thing, or a camera stands elsewhere.");
  else for (const name of off) told.push(`The click in ${name} is beyond 3 σ: the others agree without it.`);
  if (spot.angle < FLAT) told.push("The rays are nearly parallel, so ± is large. A view from the side would help.");
  return told;
}
