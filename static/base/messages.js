/**
 * Every text an annotator reads goes through these two functions. They are named as gettext names them,
 * so that `makemessages -d djangojs` finds the texts. The page carries its language's catalogue as JSON:
 * {"catalog": {text: translation | [form, form, …]}, "plurals": "1011…"}, the latter the form for 0, 1, 2 … 199.
 */
/** @type {Record<string, string|string[]>} */
let catalog = {};
/** @type {(n: number) => number} */
let pluralIndex = (n) => (n === 1 ? 0 : 1);

/** @param {{catalog: Record<string, string|string[]>, plurals: string}} language */
export function useCatalog(language) {
  catalog = language.catalog;
  const period = language.plurals.length / 2; // larger numbers have the form of the last ones with the same ending
  pluralIndex = (n) => Number(language.plurals[n < 2 * period ? n : period + (n % period)]);
}

/**
 * `gettext("Frame {number}", {number: 5})`
 * @param {string} text @param {Record<string, unknown>} [values]
 */
export function gettext(text, values = {}) {
  const translated = catalog[text];
  return fill(typeof translated === "string" && translated ? translated : text, values);
}

/**
 * `ngettext("{n} person", "{n} people", 3)`; `n` is filled in by itself.
 * @param {string} one @param {string} many @param {number} n @param {Record<string, unknown>} [values]
 */
export function ngettext(one, many, n, values = {}) {
  const translated = catalog[one];
  const forms = Array.isArray(translated) ? translated : [one, many];
  return fill(forms[Math.min(pluralIndex(n), forms.length - 1)], { n, ...values });
}

/** @param {string} text @param {Record<string, unknown>} values */
function fill(text, values) {
  return text.replace(/\{(\w+)\}/g, (whole, name) => (name in values ? String(values[name]) : whole));
}
