/**
 * What an annotator has chosen, kept in this browser. Every row of the table is one choice with its default;
 * rows with a label appear in the dialog, the others (layouts, keys, hints shown …) are only remembered.
 */
import { Emitter } from "../base/emitter.js";
import { gettext } from "../base/messages.js";

const PREFIX = "gtm-workbench-";

/**
 * @typedef {{value: any, label?: () => string, group?: string, choices?: () => [any, string][],
 *            range?: {min: number, max: number, step: number}, hint?: () => string}} Row
 * true or false: a check box; with `choices`: a menu; with `range`: a slider.
 */

/** @type {Record<string, Row>} */
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

const GROUPS = {
  placing: () => gettext("Placing"),
  moving: () => gettext("Moving"),
  seeing: () => gettext("Seeing"),
  time: () => gettext("Going through the frames"),
  other: () => gettext("Everything else"),
};

/** Emits `change` {name, value}, also for what another tab of this browser chose. */
export class Settings extends Emitter {
  constructor(storage = safeStorage()) {
    super();
    this._storage = storage;
    this._values = new Map(Object.keys(TABLE).map((name) => [name, this._read(name)]));
    window.addEventListener("storage", ({ key }) => key?.startsWith(PREFIX) && this._reread(key.slice(PREFIX.length)));
  }

  get(name) {
    if (!this._values.has(name)) throw new RangeError(`unknown setting ${name}`);
    return this._values.get(name);
  }

  set(name, value) {
    if (!fits(TABLE[name], value)) throw new TypeError(`setting ${name} cannot be ${JSON.stringify(value)}`);
    this._values.set(name, value);
    try {
      this._storage?.setItem(PREFIX + name, JSON.stringify(value));
    } catch {
      // the choice then lasts for this page only
    }
    this.emit("change", { name, value });
  }

  reset(name) {
    this.set(name, structuredClone(TABLE[name].value));
  }

  /** Call at once and whenever it changes. @returns {() => void} stops it */
  watch(name, listener) {
    listener(this.get(name));
    return this.on("change", (change) => change.name === name && listener(change.value));
  }

  _reread(name) {
    if (!(name in TABLE)) return;
    this._values.set(name, this._read(name));
    this.emit("change", { name, value: this.get(name) });
  }

  /** What was stored by an older version, or by hand, may not fit any more. */
  _read(name) {
    try {
      const value = JSON.parse(this._storage?.getItem(PREFIX + name) ?? "null");
      if (fits(TABLE[name], value)) return value;
    } catch {
      // not JSON, or storage is forbidden
    }
    return structuredClone(TABLE[name].value);
  }
}

/** Groups of rows for the dialog: [{title, rows: [{name, ...row}]}]. */
export function settingGroups() {
  return Object.entries(GROUPS)
    .map(([group, title]) => ({
      title: title(),
      rows: Object.entries(TABLE)
        .filter(([, row]) => row.label && row.group === group)
        .map(([name, row]) => ({ name, ...row })),
    }))
    .filter(({ rows }) => rows.length);
}

function pathChoices() {
  return [
    ["none", gettext("none")],
    ["selected", gettext("of the selected person")],
    ["all", gettext("of everybody")],
  ];
}

function fits(row, value) {
  if (!row || value === null || kind(value) !== kind(row.value)) return false;
  if (row.choices) return row.choices().some(([choice]) => choice === value);
  if (row.range) return value >= row.range.min && value <= row.range.max;
  return true;
}

/** Choices that are also options of display, by the name they have there. */
export const DISPLAYED = ["labelOpacity", "boxOpacity", "outline", "grid", "directions"];

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
