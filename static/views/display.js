/**
 * How panes draw before anybody has chosen anything: the options of `Panes`, all of them.
 * @typedef {{ground: string, weak: string, strong: string, cameras: string[]}} MapColours
 * @typedef {object} Options
 * @property {boolean} outline of the grid
 * @property {boolean} directions where the arrow keys lead
 * @property {boolean} grid lines every metre
 * @property {number} labelOpacity 0: no labels
 * @property {number} boxOpacity
 * @property {MapColours} mapColours
 * @returns {Options}
 */
export function startOptions() {
  return { outline: false, directions: false, grid: false, labelOpacity: 1, boxOpacity: 1, mapColours: mapColours() };
}

/**
 * The map's colours are the page's; a canvas cannot read them itself.
 * @returns {MapColours}
 */
export function mapColours() {
  const style = getComputedStyle(document.documentElement);
  /** @param {string} name */
  const value = (name) => style.getPropertyValue(name).trim();
  return {
    ground: value("--map-ground"),
    weak: value("--map-weak"),
    strong: value("--map-strong"),
    cameras: value("--map-cameras").split(","),
  };
}
