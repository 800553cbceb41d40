/* PNG of a figure, made from its SVG on the reader's own computer: three times the size, black on white. */

const SCALE = 3;

for (const figure of document.querySelectorAll("figure[data-figure]")) {
  const button = figure.querySelector("[data-png]");
  button.hidden = false;
  button.addEventListener("click", async () =>
    save(await png(figure.querySelector("svg")), `${figure.dataset.figure}.png`),
  );
}

async function png(svg) {
  const copy = svg.cloneNode(true);
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
    ctx.fillStyle = "#fff";
    ctx.fillRect(0, 0, canvas.width, canvas.height);
    ctx.drawImage(picture, 0, 0, canvas.width, canvas.height);
    return await canvas.convertToBlob({ type: "image/png" });
  } finally {
    URL.revokeObjectURL(address);
  }
}

function save(blob, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
