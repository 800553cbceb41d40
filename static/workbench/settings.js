/**
 * What an annotator has chosen, kept in this browser. Every row of the table is one choice with its default;
 * rows with a label appear in the dialog, the others (layouts, keys, hints shown …) are only remembered.
 */
import { Emitter } from "../base/emitter.js";
import { gettext } from "../base/messages.js";

const PREFIX = "gtm-workbench-";

/**
 * @typedef {"none"|"selected"|"all"} WhosePaths
 * @typedef {{brightness: number, contrast: number, gamma: number}} Tone 1 is the picture as it is
 * @typedef {object} Values what can be chosen, by the names of the table
 * @property {"screen"|"ground"} arrowAxes
 * @property {boolean} heldKeysSpeedUp
 * @property {boolean} ghost
 * @property {number} playSpeed
 * @property {WhosePaths} pathsOnMap
 * @property {WhosePaths} pathsInViews
 * @property {number} labelOpacity
 * @property {number} boxOpacity
 * @property {boolean} outline
 * @property {boolean} grid
 * @property {boolean} directions
 * @property {boolean} hints
 * @property {string[]} hintsShown
 * @property {Record<string, string[]>} keys chords by the ids of the key table
 * @property {string[]} hiddenViews
 * @property {string} largeView empty: none
 * @property {Record<string, Partial<Tone>>} tones by the ids of views
 * @property {boolean} filmstrip
 * @property {boolean} warningsOpen
 *
 * @typedef {keyof Values} Name
 * @typedef {{[One in Name]: Values[One] extends boolean ? One : never}[Name]} Switch those that are on or off
 * @typedef {{[One in Name]: {name: One, value: Values[One]}}[Name]} Change
 * @typedef {"placing"|"moving"|"seeing"|"time"|"other"} Group
 */

/**
 * true or false: a check box; with `choices`: a menu; with `range`: a slider.
 * @template Value
 * @typedef {{value: Value, label?: () => string, group?: Group, choices?: () => [Value, string][],
 *            range?: {min: number, max: number, step: number}, hint?: () => string}} Row
 */

/**
 * A row as the dialog shows it.
 * @template {Name} One
 * @typedef {Row<Values[One]> & {name: One, label: () => string}} LabelledRow
 */

/** @type {{[One in Name]: Row<Values[One]>}} */
const TABLE = {
  arrowAxes: {
    value: "screen",
    group: "moving",
    label: () => gettext("Arrow keys follow"),
    choices: () => [
      ["screen", gettext("the screen, in the view under the pointer")],
      ["ground", gettext("the axes of the ground, in every view")],
    ],
  },
  heldKeysSpeedUp: {
    value: true,
    group: "moving",
    label: () => gettext("Arrow keys held for long speed up"),
    hint: () => gettext("The first 60 repeats move one position each, then two, then four."),
  },
  ghost: {
    value: true,
    group: "placing",
    label: () => gettext("Show what a click would place"),
  },
  playSpeed: {
    value: 2,
    group: "time",
    label: () => gettext("Frames are played"),
    choices: () => [
      [0.5, gettext("at half speed")],
      [1, gettext("as fast as it happened")],
      [2, gettext("twice as fast")],
      [4, gettext("four times as fast")],
    ],
  },
  pathsOnMap: { value: "selected", group: "time", label: () => gettext("Paths on the map"), choices: pathChoices },
  pathsInViews: { value: "none", group: "time", label: () => gettext("Paths in the views"), choices: pathChoices },
  labelOpacity: {
    value: 1,
    group: "seeing",
    label: () => gettext("Numbers of people"),
    range: { min: 0, max: 1, step: 0.1 },
    hint: () => gettext("At the left end: none."),
  },
  boxOpacity: {
    value: 1,
    group: "seeing",
    label: () => gettext("Boxes, except the selected one"),
    range: { min: 0.1, max: 1, step: 0.1 },
  },
  outline: { value: false, group: "seeing", label: () => gettext("Show the border of the ground area") },
  grid: { value: false, group: "seeing", label: () => gettext("Show a grid of metres on the ground") },
  directions: { value: false, group: "seeing", label: () => gettext("Show where the arrow keys lead") },
  hints: {
    value: true,
    group: "other",
    label: () => gettext("Hints"),
    hint: () => gettext("Each one comes once; switched on again, once more."),
  },
  hintsShown: { value: [] },
  keys: { value: {} },
  hiddenViews: { value: [] },
  largeView: { value: "" },
  tones: { value: {} },
  filmstrip: { value: false },
  warningsOpen: { value: true },
};
const NAMES = /** @type {Name[]} */ (Object.keys(TABLE));

/** @type {Record<Group, () => string>} */
const GROUPS = {
  placing: () => gettext("Placing"),
  moving: () => gettext("Moving"),
  seeing: () => gettext("Seeing"),
  time: () => gettext("Going through the frames"),
  other: () => gettext("Everything else"),
};

/**
 * Emits `change` {name, value}, also for what another tab of this browser chose.
 * @extends {Emitter<{change: Change}>}
 */
export class Settings extends Emitter {
  /** @param {Storage|null} storage null: choices last for this page only */
  constructor(storage = safeStorage()) {
    super();
    this._storage = storage;
    this._values = /** @type {Values} */ (Object.fromEntries(NAMES.map((name) => [name, this._read(name)])));
    window.addEventListener("storage", ({ key }) => key?.startsWith(PREFIX) && this._reread(key.slice(PREFIX.length)));
  }

  /** @template {Name} One @param {One} name @returns {Values[One]} */
  get(name) {
    if (!isName(name)) throw new RangeError(`unknown setting ${name}`);
    return this._values[name];
  }

  /** @template {Name} One @param {One} name @param {Values[One]} value */
  set(name, value) {
    if (!fits(name, value)) throw new TypeError(`setting ${name} cannot be ${JSON.stringify(value)}`);
    this._values[name] = value;
    try {
      this._storage?.setItem(PREFIX + name, JSON.stringify(value));
    } catch {
      // the choice then lasts for this page only
    }
    this._tell(name);
  }

  /** @param {Name} name */
  reset(name) {
    this.set(name, valueAtFirst(name));
  }

  /**
   * Call at once and whenever it changes.
   * @template {Name} One
   * @param {One} name @param {(value: Values[One]) => void} listener
   * @returns {() => void} stops it
   */
  watch(name, listener) {
    listener(this.get(name));
    return this.on("change", (change) => change.name === name && listener(this.get(name)));
  }

  /** @param {string} name */
  _reread(name) {
    if (!isName(name)) return;
    Object.assign(this._values, { [name]: this._read(name) });
    this._tell(name);
  }

  /** @param {Name} name */
  _tell(name) {
    this.emit("change", /** @type {Change} */ ({ name, value: this.get(name) }));
  }

  /**
   * What was stored by an older version, or by hand, may not fit any more.
   * @template {Name} One
   * @param {One} name @returns {Values[One]}
   */
  _read(name) {
    try {
      /** @type {unknown} */
      const value = JSON.parse(this._storage?.getItem(PREFIX + name) ?? "null");
      if (fits(name, value)) return value;
    } catch {
      // not JSON, or storage is forbidden
    }
    return valueAtFirst(name);
  }
}

/** @template {Name} One @param {One} name @returns {Values[One]} */
function valueAtFirst(name) {
  return structuredClone(TABLE[name].value);
}

/** Groups of rows for the dialog. */
export function settingGroups() {
  return Object.entries(GROUPS)
    .map(([group, title]) => ({ title: title(), rows: NAMES.flatMap((name) => labelled(name, group)) }))
    .filter(({ rows }) => rows.length);
}

/** @template {Name} One @param {One} name @param {string} group @returns {LabelledRow<One>[]} one, or none */
function labelled(name, group) {
  /** @type {Row<Values[One]>} */
  const row = TABLE[name];
  return row.label && row.group === group ? [{ ...row, name, label: row.label }] : [];
}

/** @returns {[WhosePaths, string][]} */
function pathChoices() {
  return [
    ["none", gettext("none")],
    ["selected", gettext("of the selected person")],
    ["all", gettext("of everybody")],
  ];
}

/** @param {string} name @returns {name is Name} */
function isName(name) {
  return NAMES.some((one) => one === name);
}

/** @template {Name} One @param {One} name @param {unknown} value @returns {value is Values[One]} */
function fits(name, value) {
  const row = isName(name) && TABLE[name];
  if (!row || value === null || kind(value) !== kind(row.value)) return false;
  if (row.choices) return row.choices().some(([choice]) => choice === value);
  if (row.range) return Number(value) >= row.range.min && Number(value) <= row.range.max;
  return true;
}

/**
 * Choices that are also options of display, by the name they have there.
 * @type {("labelOpacity"|"boxOpacity"|"outline"|"grid"|"directions")[]}
 */
export const DISPLAYED = ["labelOpacity", "boxOpacity", "outline", "grid", "directions"];

/** @param {unknown} value */
function kind(value) {
  return Array.isArray(value) ? "array" : typeof value;
}

function safeStorage() {
  try {
    return window.localStorage;
  } catch {
    return null; // storage may be forbidden
  }
}
