// Says that a file is too large before it travels, and sends it once.

/** @type {HTMLFormElement|null} */
const form = document.querySelector("[data-upload]");
/** @type {HTMLInputElement|null|undefined} */
const file = form?.querySelector("[data-most-bytes]");
/** @type {HTMLButtonElement|null|undefined} */
const button = form?.querySelector("button.primary");
if (!form || !file || !button) throw new TypeError("there is no form to send a file with");

file.addEventListener("change", () => {
  const tooLarge = (file.files?.[0]?.size ?? 0) > Number(file.dataset.mostBytes);
  file.setCustomValidity((tooLarge && file.dataset.tooLarge) || "");
  file.reportValidity();
});

form.addEventListener("submit", () => {
  button.disabled = true;
});

// Back from the next page, the browser may show this one as it was left.
addEventListener("pageshow", () => {
  button.disabled = false;
});

export {}; // a module: its names are its own
