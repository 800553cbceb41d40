/**
 * Brightness, contrast and gamma of a pane's picture, as filters of the page: the pictures stay as they are.
 * @typedef {{brightness: number, contrast: number, gamma: number}} Tone 1 is the picture as it is
 * @type {Readonly<Tone>}
 */
export const PLAIN = Object.freeze({ brightness: 1, contrast: 1, gamma: 1 });
export const RANGE = Object.freeze({ min: 0.4, max: 2.5, step: 0.05 });

const SVG = "http://www.w3.org/2000/svg";

/** @param {import("./pane.js").Pane} pane @param {Tone} tone */
export function paintTone(pane, { brightness, contrast, gamma }) {
  const [light, span, power] = [brightness, contrast, gamma].map(allowed);
  /** @type {string[]} */
  const parts = [];
  if (power !== 1) parts.push(`url("#${gammaFilter(pane.view.id, power)}")`);
  if (light !== 1) parts.push(`brightness(${light})`);
  if (span !== 1) parts.push(`contrast(${span})`);
  pane.setFilter(parts.join(" "));
}

/**
 * What is remembered may come from an older version, or from a hand.
 * @param {number} value
 */
function allowed(value) {
  return Number.isFinite(value) ? Math.min(RANGE.max, Math.max(RANGE.min, value)) : 1;
}

/**
 * More than 1 lifts the shadows.
 * @param {string} view @param {number} gamma
 * @returns {string} the id of the filter
 */
function gammaFilter(view, gamma) {
  const id = `gamma-${view}`;
  const filter = document.getElementById(id) ?? makeFilter(id);
  for (const channel of filter.querySelectorAll("[type=gamma]")) channel.setAttribute("exponent", String(1 / gamma));
  return id;
}

/** @param {string} id */
function makeFilter(id) {
  const svg = document.createElementNS(SVG, "svg");
  svg.setAttribute("class", "visually-hidden");
  svg.setAttribute("aria-hidden", "true");
  const filter = document.createElementNS(SVG, "filter");
  filter.id = id;
  filter.setAttribute("color-interpolation-filters", "sRGB");
  const transfer = document.createElementNS(SVG, "feComponentTransfer");
  for (const name of ["feFuncR", "feFuncG", "feFuncB"]) {
    const channel = document.createElementNS(SVG, name);
    channel.setAttribute("type", "gamma");
    transfer.append(channel);
  }
  filter.append(transfer);
  svg.append(filter);
  document.body.append(svg);
  return filter;
}
