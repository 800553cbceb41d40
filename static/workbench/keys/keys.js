/**
 * The one table of keys: the keyboard, the help sheet and the tooltips are made from it. `keys` are chords as
 * `chord()` of key_press.js writes them. `labels` are texts for translation. An annotator may have chosen other keys.
 * @typedef {"person"|"people"|"identity"|"frame"|"view"|"other"} Group
 * @typedef {{id: string, group: Group, keys: string[], label: string, fixed: boolean}} KeyRow `fixed`: it cannot be changed
 */
import { gettext } from "../../base/messages.js";

/** @type {Record<Group, () => string>} */
const GROUPS = {
  person: () => gettext("The selected person"),
  people: () => gettext("Choosing people"),
  identity: () => gettext("Who is who"),
  frame: () => gettext("Frames"),
  view: () => gettext("Views"),
  other: () => gettext("Everything else"),
};

/** @type {[id: string, group: Group, keys: string[], label: () => string][]} */
const TABLE = [
  ["left", "person", ["ArrowLeft"], () => gettext("one step to the left, as the active view shows it")],
  ["right", "person", ["ArrowRight"], () => gettext("one step to the right")],
  ["up", "person", ["ArrowUp"], () => gettext("one step away from the camera")],
  ["down", "person", ["ArrowDown"], () => gettext("one step towards the camera")],
  ["leftFar", "person", ["Shift+ArrowLeft"], () => gettext("ten steps to the left")],
  ["rightFar", "person", ["Shift+ArrowRight"], () => gettext("ten steps to the right")],
  ["upFar", "person", ["Shift+ArrowUp"], () => gettext("ten steps away from the camera")],
  ["downFar", "person", ["Shift+ArrowDown"], () => gettext("ten steps towards the camera")],
  ["moveHere", "person", ["d"], () => gettext("move under the pointer, as a right click does")],
  ["heads", "person", ["y"], () => gettext("clicks mean the top of the head, for hidden feet; and back")],
  ["validate", "person", ["e"], () => gettext("validate: the position is right")],
  ["validateNext", "person", ["Enter"], () => gettext("validate and go to the next yellow person")],
  ["taller", "person", ["}", "PageUp"], () => gettext("taller, by 2 cm; later frames keep it")],
  ["shorter", "person", ["{", "PageDown"], () => gettext("shorter, by 2 cm")],
  ["wider", "person", ["]", "Shift+PageUp"], () => gettext("wider, by 2 cm")],
  ["narrower", "person", ["[", "Shift+PageDown"], () => gettext("narrower, by 2 cm")],
  ["usualSize", "person", ["\\"], () => gettext("the usual height and width again")],
  ["remove", "person", ["Backspace", "Delete"], () => gettext("remove from this frame")],
  ["nextPerson", "people", ["Tab"], () => gettext("next person")],
  ["previousPerson", "people", [" ", "Shift+Tab"], () => gettext("previous person")],
  ["nextCarried", "people", ["f"], () => gettext("next yellow person, still to be looked at")],
  ["validateAll", "people", ["Shift+Enter"], () => gettext("validate everybody: all yellow people stand right")],
  ["round", "people", ["a"], () => gettext("one by one, close up: right click places and goes on, Enter: it is right")],
  ["roundBack", "people", ["b"], () => gettext("the person before, when one by one")],
  ["sheet", "people", ["Shift+s"], () => gettext("everybody of the frame side by side, close up; and back")],
  ["rename", "identity", ["r"], () => gettext("give the person another number")],
  ["split", "identity", ["x"], () => gettext("split: from here on it is somebody else, with a new number")],
  ["join", "identity", ["Shift+j"], () => gettext("join: another number is the same person")],
  ["swap", "identity", ["Shift+x"], () => gettext("swap the person with another from here on")],
  ["removeMore", "identity", ["Shift+Delete", "Shift+Backspace"], () => gettext("remove from several frames")],
  ["nextWarning", "identity", ["q"], () => gettext("go to the next warning")],
  ["dismissWarning", "identity", ["Shift+q"], () => gettext("dismiss that warning: it is right as it is")],
  ["nextFrame", "frame", ["n"], () => gettext("next frame; this one is done")],
  ["previousFrame", "frame", ["p"], () => gettext("previous frame")],
  ["bring", "frame", ["l"], () => gettext("load the people of the previous frame who are missing here")],
  ["bringNext", "frame", ["j"], () => gettext("load the people of the next frame who are missing here")],
  ["copyPrevious", "frame", ["c"], () => gettext("copy a person exactly from the previous frame")],
  ["copyNext", "frame", ["Shift+c"], () => gettext("copy a person exactly from the next frame")],
  ["fill", "frame", ["i"], () => gettext("fill in between the frames in which the person is validated")],
  ["nextTask", "frame", ["g"], () => gettext("go to what is left to do")],
  ["play", "frame", ["k"], () => gettext("play the frames, and stop")],
  ["lookNext", "frame", [">"], () => gettext("look at the next frame, without saying anything about this one")],
  ["lookPrevious", "frame", ["<"], () => gettext("look at the previous frame")],
  ["reload", "frame", ["Shift+l"], () => gettext("load this frame from the server again")],
  ["save", "frame", ["s", "Ctrl+s"], () => gettext("save now (it also happens by itself)")],
  ["zoom", "view", ["z"], () => gettext("zoom all views to the selected person, and back")],
  ["largeView", "view", ["v"], () => gettext("the active view large, and back")],
  [
    "toggleView",
    "view",
    ["1", "2", "3", "4", "5", "6", "7", "8", "9"],
    () => gettext("hide that view, or show it again"),
  ],
  ["allViews", "view", ["0"], () => gettext("all views, alike")],
  ["views", "view", ["u"], () => gettext("which views are shown, brightness and contrast of each")],
  ["outline", "view", ["t"], () => gettext("show the border of the ground area")],
  ["grid", "view", ["Shift+t"], () => gettext("show a grid of metres on the ground")],
  ["pathsInViews", "view", ["w"], () => gettext("paths in the views: none, of the selected person, of everybody")],
  ["pathsOnMap", "view", ["Shift+w"], () => gettext("paths on the map: none, of the selected person, of everybody")],
  ["filmstrip", "view", ["m"], () => gettext("show the selected person over all frames")],
  ["directions", "view", ["h"], () => gettext("show where the arrow keys lead")],
  ["undo", "other", ["Ctrl+z"], () => gettext("undo")],
  ["redo", "other", ["Ctrl+y", "Ctrl+Shift+z"], () => gettext("redo")],
  ["history", "frame", ["Shift+h"], () => gettext("who saved this frame and when; look at it and restore it")],
  ["help", "other", ["?", "F1"], () => gettext("this sheet")],
  ["settings", "other", [","], () => gettext("settings")],
  ["controls", "other", ["F6"], () => gettext("move between buttons with Tab; Escape returns to annotating")],
  ["escape", "other", ["Escape"], () => gettext("leave zoom, then let go of the person")],
];

/**
 * Rows of a part that is fetched later; whoever adds them tells the keyboard.
 * @param {typeof TABLE} rows
 */
export function addKeys(rows) {
  TABLE.push(...rows);
}

/** Who counts on finding them: the way out, and digits that mean views. */
const FIXED = ["toggleView", "controls", "escape"];

/** @type {Record<string, string[]>} */
let chosen = {};

/** @param {Record<string, string[]>} keys chords by id; whatever is not in it has the keys of the table */
export function useKeys(keys) {
  const reserved = TABLE.filter(([id]) => FIXED.includes(id)).flatMap(([, , own]) => own);
  /** @param {[id: string, own: unknown]} entry as it was stored, perhaps by hand */
  const fits = ([id, own]) =>
    !FIXED.includes(id) &&
    Array.isArray(own) &&
    own.length &&
    own.every((key) => typeof key === "string" && !reserved.includes(key));
  chosen = Object.fromEntries(Object.entries(keys).filter(fits));
}

/** @returns {KeyRow[]} in the order of the help sheet */
export function keyTable() {
  const taken = new Set(Object.values(chosen).flat());
  return TABLE.map(([id, group, keys, label]) => ({
    id,
    group,
    keys: chosen[id] ?? keys.filter((key) => !taken.has(key)),
    label: label(),
    fixed: FIXED.includes(id),
  }));
}

/**
 * Who has that key already, other than `id`: a row of the table, or null.
 * @param {string} id @param {string} key
 */
export function clash(id, key) {
  return keyTable().find((row) => row.id !== id && row.keys.includes(key)) ?? null;
}

/** @param {string} id */
function rowOf(id) {
  const found = keyTable().find((row) => row.id === id);
  if (!found) throw new RangeError(`unknown action ${id}`);
  return found;
}

/**
 * What to press for `id`, as it is printed on keys.
 * @param {string} id
 */
export function keyFor(id) {
  const [key] = rowOf(id).keys;
  return key ? keyName(key) : gettext("no key");
}

/**
 * Tooltip of a button that does the same as `id`: what it does, and the key.
 * @param {string} id
 */
export function titleFor(id) {
  const { keys, label } = rowOf(id);
  return keys.length ? `${label} (${keyName(keys[0])})` : label;
}

/** @param {Group} group */
export function groupTitle(group) {
  return GROUPS[group]();
}

/**
 * A chord as it is printed on keys.
 * @param {string} text
 */
export function keyName(text) {
  /** @type {Record<string, string>} */
  const names = { ArrowLeft: "←", ArrowRight: "→", ArrowUp: "↑", ArrowDown: "↓", " ": gettext("Space"), Escape: "Esc" };
  return text
    .split("+")
    .map((part) => names[part] ?? (part.length === 1 ? part.toUpperCase() : part))
    .join(" + ");
}
