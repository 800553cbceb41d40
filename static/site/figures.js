/* PNG of a figure, made from its SVG on the reader's own computer: three times the size, black on white. */

const SCALE = 3;

/** @type {NodeListOf<HTMLElement>} */
const figures = document.querySelectorAll("figure[data-figure]");

for (const figure of figures) {
  /** @type {HTMLButtonElement|null} */
  const button = figure.querySelector("[data-png]");
  const svg = figure.querySelector("svg");
  if (!button || !svg) continue;
  button.hidden = false;
  button.addEventListener("click", async () => save(await png(svg), `${figure.dataset.figure}.png`));
}

/** @param {SVGSVGElement} svg */
async function png(svg) {
  const copy = /** @type {SVGSVGElement} */ (svg.cloneNode(true));
  copy.setAttribute("color", "#000"); // what currentColor means on paper
  const source = new Blob([new XMLSerializer().serializeToString(copy)], { type: "image/svg+xml" });
  const address = URL.createObjectURL(source);
  try {
    const picture = new Image();
    picture.src = address;
    await picture.decode();
    const { width, height } = svg.viewBox.baseVal;
    const canvas = new OffscreenCanvas(Math.round(width * SCALE), Math.round(height * SCALE));
    const ctx = canvas.getContext("2d");
    if (!ctx) throw new Error("this browser cannot draw");
    ctx.fillStyle = "#fff";
    ctx.fillRect(0, 0, canvas.width, canvas.height);
    ctx.drawImage(picture, 0, 0, canvas.width, canvas.height);
    return await canvas.convertToBlob({ type: "image/png" });
  } finally {
    URL.revokeObjectURL(address);
  }
}

/** @param {Blob} blob @param {string} name */
function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

export {}; // a module: its names are its own
