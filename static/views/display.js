/** How panes draw before anybody has chosen anything: the options of `Panes`, all of them. */
export function startOptions() {
  return { outline: false, directions: false, grid: false, labelOpacity: 1, boxOpacity: 1, mapColours: mapColours() };
}

/** The map's colours are the page's; a canvas cannot read them itself. */
export function mapColours() {
  const style = getComputedStyle(document.documentElement);
  const value = (name) => style.getPropertyValue(name).trim();
  return {
    ground: value("--map-ground"),
    weak: value("--map-weak"),
    strong: value("--map-strong"),
    cameras: value("--map-cameras").split(","),
  };
}
