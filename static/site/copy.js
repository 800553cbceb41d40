// Copy buttons: [data-copy] copies the [data-copy-source] beside it.

/** @type {NodeListOf<HTMLButtonElement>} */
const buttons = document.querySelectorAll("[data-copy]");

for (const button of buttons) {
  /** @type {HTMLInputElement|null|undefined} */
  const source = button.parentElement?.querySelector("[data-copy-source]");
  if (!source) continue;
  const label = button.textContent;
  button.hidden = false;
  button.addEventListener("click", async () => {
    source.select();
    try {
      await navigator.clipboard.writeText(source.value);
    } catch {
      document.execCommand("copy"); // pages served without TLS have no clipboard
    }
    button.textContent = button.dataset.copied ?? label;
    setTimeout(() => (button.textContent = label), 2000);
  });
}

export {}; // a module: its names are its own
