/**
 * CSS pixels of one unit of drawing: what is drawn grows on large screens as the letters do (html in
 * workbench.css). Measured at the first use, and again whenever the window has another size.
 * @type {number|null}
 */
let measured = null;

export function unit() {
  if (measured === null) {
    measured = measure();
    window.addEventListener("resize", () => (measured = measure())); // before anything learns that its own size changed
  }
  return measured;
}

function measure() {
  return parseFloat(getComputedStyle(document.documentElement).fontSize) / 10;
}
