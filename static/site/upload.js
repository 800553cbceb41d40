// Says that a file is too large before it travels, and sends it once.

const form = document.querySelector("[data-upload]");
const file = form.querySelector("[data-most-bytes]");
const button = form.querySelector("button.primary");

file.addEventListener("change", () => {
  const tooLarge = file.files[0]?.size > Number(file.dataset.mostBytes);
  file.setCustomValidity(tooLarge ? file.dataset.tooLarge : "");
  file.reportValidity();
});

form.addEventListener("submit", () => {
  button.disabled = true;
});

// Back from the next page, the browser may show this one as it was left.
addEventListener("pageshow", () => {
  button.disabled = false;
});
