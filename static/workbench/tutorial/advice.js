/** Which way a box has to go, in arrow keys or in words, as a view shows it. */

import { gettext } from "../../base/messages.js";

/**
 * @typedef {import("../../geometry/directions.js").Axes} Axes
 * @typedef {import("../../geometry/directions.js").Key} Key
 * @typedef {{key: Key, times: number}} Presses
 */

const FEW = 24; // presses; a click is quicker than more

/** @type {Record<Key, () => string>} */
const WORDS = {
  left: () => gettext("further left"),
  right: () => gettext("further right"),
  up: () => gettext("further back"),
  down: () => gettext("nearer"),
};

/**
 * The presses that lead some columns and rows on, most first.
 * @param {Axes} axes @param {number} columns @param {number} rows
 * @returns {Presses[]}
 */
export function presses(axes, columns, rows) {
  const keys = /** @type {Key[]} */ (Object.keys(axes));
  return keys
    .map((key) => ({ key, times: axes[key].columns * columns + axes[key].rows * rows }))
    .filter(({ times }) => times > 0)
    .sort((one, other) => other.times - one.times);
}

/**
 * @param {Presses[]} needed @param {string} view its title
 * @param {(key: Key) => string} label of the key as it is set
 */
export function adviceFor(needed, view, label) {
  const total = needed.reduce((sum, { times }) => sum + times, 0);
  if (!total) return "";
  if (total > FEW)
    return gettext("Click with the right button between the feet: in {view} they are {direction}.", {
      view,
      direction: needed.map(({ key }) => WORDS[key]()).join(gettext(" and ")),
    });
  const keys = needed.map(({ key, times }) => gettext("{key} {n}×", { key: label(key), n: times }));
  return gettext("Press {keys}, with the pointer over {view}.", { keys: keys.join(gettext(" and ")), view });
}
