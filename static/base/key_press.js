/**
 * What was pressed, whatever keyboard it was pressed on. Pure.
 * @typedef {{key: string, code?: string, shiftKey?: boolean, ctrlKey?: boolean, altKey?: boolean, metaKey?: boolean,
 *            getModifierState?: (key: string) => boolean}} Press a keyboard event, or as much of it as is known
 */

/** @type {Record<string, string>} */
const SYMBOLS = {
  BracketLeft: "[{",
  BracketRight: "]}",
  Backslash: "\\|",
  Comma: ",<",
  Period: ".>",
  Slash: "/?",
  Semicolon: ";:",
  Quote: "'\"",
  Backquote: "`~",
  Minus: "-_",
  Equal: "=+",
};
const UNNAMED = ["Process", "Unidentified"]; // what browsers say while an input method listens
const LETTER = /^\p{Letter}$/u;
const ASCII = /^[ -~]$/;
const LATIN = /^\p{Script=Latin}$/u;
/** Letters, vowel signs and digits, not Latin ones; µ and the like belong to no script. One key may give two (لا). */
const FOREIGN =
  /^(?:(?![\p{Script=Latin}\p{Script=Common}\p{Script=Inherited}])[\p{Letter}\p{Mark}]|(?![0-9])\p{Nd})+$/u;
const SIGN = /^[!-/:-@[-`{-~]$/; // on many keyboards only to be had with AltGr or Option

/**
 * A keyboard event as text: "Shift+ArrowLeft", "Ctrl+z", "?". Command counts as Ctrl.
 * @param {Press} event @param {boolean} [foreign]
 */
export function chord(event, foreign = false) {
  const key = typed(event, foreign);
  const { ctrl, alt } = modifiers(event, key);
  const shifted = event.shiftKey && (key.length > 1 || key === " " || LETTER.test(key));
  return [ctrl ? "Ctrl+" : "", alt ? "Alt+" : "", shifted ? "Shift+" : "", key].join("");
}

/**
 * The character or name of a key. Keys of a keyboard without Latin letters, or with an input method on, mean what
 * is at their place on an American keyboard.
 * @param {Press} event
 * @param {boolean} [foreign] whether letters of that keyboard are not Latin: then its signs on letter keys are by place, too
 */
export function typed(event, foreign = false) {
  const { key } = event;
  const place = UNNAMED.includes(key) || FOREIGN.test(key) || (foreign && isSignOfIt(event)) ? atPlace(event) : null;
  return place ?? (key.length === 1 ? key.toLowerCase() : key);
}

/**
 * What a key tells about its keyboard: whether its letters are foreign, or null when it is no letter.
 * @param {Press} event
 */
export function tellsForeign({ key }) {
  if (FOREIGN.test(key)) return true;
  return LATIN.test(key) ? false : null;
}

/**
 * A sign where others have a letter, or one that is not even ASCII; what AltGr or Option makes of a key is meant as it is.
 * @param {Press} event
 */
function isSignOfIt(event) {
  const { key, code = "", altKey } = event;
  if (altKey || event.getModifierState?.("AltGraph") || [...key].length !== 1) return false;
  return ASCII.test(key) ? SIGN.test(key) && code.startsWith("Key") : !LATIN.test(key);
}

/** @param {Press} event */
function atPlace({ code = "", shiftKey }) {
  const [, plain] = /^(?:Key|Digit|Numpad)([A-Z0-9])$/.exec(code) ?? [];
  if (code.startsWith("Digit") && shiftKey) return ")!@#$%^&*("[Number(plain)];
  return plain?.toLowerCase() ?? SYMBOLS[code]?.[shiftKey ? 1 : 0] ?? null;
}

/**
 * AltGr (which Windows reports as Ctrl and Alt) and Option have made the sign: they are no part of what is meant.
 * @param {Press} event @param {string} key
 */
function modifiers(event, key) {
  const [ctrl, alt] = [event.ctrlKey || event.metaKey, event.altKey];
  const made = event.getModifierState?.("AltGraph") && key.length === 1;
  const windows = event.ctrlKey && alt && !event.metaKey;
  const mac = alt && !ctrl && /^Mac/.test(globalThis.navigator?.platform ?? "");
  return made || ((windows || mac) && SIGN.test(key)) ? { ctrl: false, alt: false } : { ctrl, alt };
}
