// The form of a campaign's rules: what it comes to while one types, and only the chosen platform's settings.

const form = /** @type {HTMLFormElement} */ (document.querySelector("[data-campaign-form]"));

/** @param {string} name */
function typed(name) {
  const field = form.elements.namedItem(name);
  const given = field instanceof HTMLInputElement || field instanceof HTMLSelectElement ? field.value : "";
  return Number(given) || 0;
}

/** As the server cuts: runs of `size` frames that begin `overlap` before the end of the one before. */
function batches() {
  const cut = form.dataset.batches;
  if (cut) return Number(cut);
  const [frames, size, overlap] = [Number(form.dataset.frames), typed("batch_size"), typed("overlap")];
  if (!frames || size <= overlap) return 0;
  return 1 + Math.max(0, Math.ceil((frames - size) / (size - overlap)));
}

/** @param {string} name @param {string} text */
function show(name, text) {
  for (const place of form.querySelectorAll(`[data-show="${name}"]`)) place.textContent = text;
}

function estimate() {
  const [one, copies, minutes] = [batches(), typed("copies"), typed("expected_minutes")];
  // Cents: sums of money are never fractions of binary numbers.
  const cents = Math.round(typed("pay_per_batch") * 100);
  const hourly = minutes ? Math.round((cents * 60) / minutes) : 0;
  const currency = form.elements.namedItem("currency");
  show("batches", String(one));
  show("all", String(one * copies));
  show("hours", ((one * copies * minutes) / 60).toFixed(1));
  show("hourly", (hourly / 100).toFixed(2));
  show("cost", ((one * copies * cents) / 100).toFixed(2));
  show("currency", currency instanceof HTMLInputElement ? currency.value : "");
  const below = /** @type {HTMLElement | null} */ (form.querySelector('[data-show="below"]'));
  if (below) below.hidden = hourly >= Math.round(typed("hourly_floor") * 100);
}

function choosePlatform() {
  const chosen = form.elements.namedItem("platform");
  if (!(chosen instanceof HTMLSelectElement)) return;
  for (const group of /** @type {NodeListOf<HTMLElement>} */ (form.querySelectorAll("[data-platform]")))
    group.hidden = group.dataset.platform !== chosen.value;
}

form.addEventListener("input", () => {
  estimate();
  choosePlatform();
});
estimate();
choosePlatform();

export {}; // a module: its names are its own
