/**
 * CSS pixels of one unit of drawing: what is drawn grows on large screens as the letters do (html in
 * workbench.css). It is up to date before anything learns that its size changed.
 */
export let unit = measured();
window.addEventListener("resize", () => (unit = measured()));

function measured() {
  return parseFloat(getComputedStyle(document.documentElement).fontSize) / 10;
}
