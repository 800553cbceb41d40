/**
 * Every text an annotator reads goes through these two functions. They are named as gettext names them,
 * so that `makemessages -d djangojs` finds the texts. A page in another language carries its catalogue as
 * JSON: {"catalog": {text: translation | [singular, plural, …]}, "plural": "n != 1"}.
 */
let catalog = {};
let pluralIndex = (n) => (n === 1 ? 0 : 1);

/** @param {{catalog?: object, pluralIndex?: (n: number) => number}} languages */
export function useCatalog(languages) {
  catalog = languages.catalog ?? {};
  pluralIndex = languages.pluralIndex ?? pluralIndex;
}

/** `gettext("Frame {number}", {number: 5})` */
export function gettext(text, values = {}) {
  const translated = catalog[text];
  return fill(typeof translated === "string" && translated ? translated : text, values);
}

/** `ngettext("{n} person", "{n} people", 3)`; `n` is filled in by itself. */
export function ngettext(one, many, n, values = {}) {
  const translated = catalog[one];
  const forms = Array.isArray(translated) ? translated : [one, many];
  return fill(forms[Math.min(pluralIndex(n), forms.length - 1)], { n, ...values });
}

function fill(text, values) {
  return text.replace(/\{(\w+)\}/g, (whole, name) => (name in values ? String(values[name]) : whole));
}
