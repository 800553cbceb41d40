/**
 * What a patch over several frames changes: in words, frame by frame, and as paths on a map before and after.
 * @typedef {import("../../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../../truth/commands.js").Patch} Patch
 * @typedef {import("../../truth/scene.js").Scene} Scene
 * @typedef {import("../../truth/store.js").Edit} Edit
 * @typedef {import("../../truth/store.js").PersonEdit} PersonEdit
 * @typedef {import("../../truth/store.js").Store} Store
 * @typedef {import("../../views/panes.js").Panes["options"]["mapColours"]} MapColours
 * @typedef {{xmin: number, ymin: number, xmax: number, ymax: number}} Box metres of the map
 * @typedef {{places: [number, number], changes: string[]}} Run of frames, by their place from 1, with the same changes
 * @typedef {{number: number, one: Annotation}} Step somebody in a frame
 * @typedef {{person: number, people: Step[]}} Path in the order of frames
 */
import { element } from "../../base/dom.js";
import { gettext, ngettext } from "../../base/messages.js";
import { unit } from "../../base/scale.js";
import { MapView } from "../../views/map_view.js";
import { drawFoot, drawLabel, drawPath } from "../../views/marks.js";
import { union } from "../../views/regions.js";
import { CYAN } from "../../views/styles.js";
import { fit, focus } from "../../views/transform.js";

const SIZE = { width: 400, height: 190 }; // CSS pixels
const AROUND = 1; // metres around the paths
const SMALLEST = 4; // metres the map shows at least
const COLOURS = [CYAN, "#ff9d5c", "#b7e36a", "#d9a6ff"];
/** @type {number[][]} */
const DASHES = [[], [7, 3], [2, 3], [9, 3, 2, 3]];

/** @param {Store} store @param {Patch} patch */
function changesOf(store, patch) {
  const edits = patch.edits.filter(isAboutPerson);
  /** @type {Run[]} */
  const runs = [];
  store.numbers.forEach((number, index) => {
    const changes = frameChanges(edits.filter((edit) => edit.frame === number));
    if (!changes.length) return;
    const last = runs.at(-1);
    if (last && last.places[1] === index && last.changes.join() === changes.join()) last.places[1] = index + 1;
    else runs.push({ places: [index + 1, index + 1], changes });
  });
  return runs;
}

/** @param {Store} store @param {Patch} patch */
export function changeList(store, patch) {
  const items = changesOf(store, patch).map(({ places: [from, to], changes }) => {
    const where = from === to ? gettext("Frame {place}", { place: from }) : gettext("Frames {from}–{to}", { from, to });
    return element("li", {}, element("strong", {}, where), `: ${changes.join("; ")}`);
  });
  return element("ul", { className: "change-list", tabIndex: 0, "aria-label": gettext("What changes") }, items);
}

/**
 * Two maps, before and after, of everybody the patch touches and of `others` who matter beside them.
 * @param {Scene} scene @param {Store} store @param {MapColours} mapColours @param {Patch} patch
 * @param {(number|null)[]} [others]
 */
export function beforeAndAfter(scene, store, mapColours, patch, others = []) {
  const edits = patch.edits.filter(isAboutPerson);
  const concerned = new Set(edits.map(({ person }) => person));
  for (const person of others) if (person !== null) concerned.add(person);
  const persons = [...concerned].sort((one, other) => one - other);
  const before = pathsOf(store, persons, new Map());
  const after = pathsOf(store, persons, new Map(edits.map((edit) => [`${edit.frame} ${edit.person}`, edit.after])));
  const view = new MapView(scene, "");
  const bounds = boundsOf(
    view,
    [...before, ...after].flatMap(({ people }) => people),
  );
  /** @param {string} title @param {Path[]} paths */
  const figure = (title, paths) =>
    element(
      "figure",
      {},
      element("figcaption", {}, title),
      drawn(view, bounds, mapColours, paths, store.current, title),
    );
  return element(
    "div",
    { className: "before-after" },
    figure(gettext("Before"), before),
    figure(gettext("After"), after),
  );
}

/** @param {Edit} edit @returns {edit is PersonEdit} */
function isAboutPerson(edit) {
  return !edit.flags;
}

/**
 * "5 becomes 9": who leaves a number is looked for where it stood.
 * @param {PersonEdit[]} edits of one frame
 */
function frameChanges(edits) {
  return edits.flatMap(({ person, before, after }) => {
    if (!before) return [];
    const now = edits.find((edit) => edit.after?.position === before.position);
    if (now && now.person !== person) return [gettext("{person} becomes {other}", { person, other: now.person })];
    if (now) return [gettext("{person} changes", { person })];
    return after && !edits.some((edit) => edit.person !== person && edit.before?.position === after.position)
      ? [gettext("{person} is filled in anew", { person })]
      : [gettext("{person} is removed", { person })];
  });
}

/**
 * Paths with the edits carried out.
 * @param {Store} store @param {number[]} persons
 * @param {Map<string, Annotation|null>} edited by frame and person @returns {Path[]}
 */
function pathsOf(store, persons, edited) {
  return persons.map((person) => {
    const people = store.numbers.flatMap((number) => {
      const key = `${number} ${person}`;
      const one = edited.has(key) ? edited.get(key) : store.person(person, number);
      return one ? [{ number, one }] : [];
    });
    return { person, people };
  });
}

/** @param {MapView} view @param {Step[]} people @returns {Box|null} */
function boundsOf(view, people) {
  /** @type {Box|null} */
  let box = null;
  for (const { one } of people) {
    const { x, y } = view.foot(one);
    box = union(box, { xmin: x - AROUND, ymin: y - AROUND, xmax: x + AROUND, ymax: y + AROUND });
  }
  if (!box) return null;
  /** @param {number} low @param {number} high */
  const grow = (low, high) => Math.max(0, SMALLEST - (high - low)) / 2;
  const [wide, high] = [grow(box.xmin, box.xmax), grow(box.ymin, box.ymax)];
  return { xmin: box.xmin - wide, xmax: box.xmax + wide, ymin: box.ymin - high, ymax: box.ymax + high };
}

/**
 * @param {MapView} view @param {Box|null} bounds @param {MapColours} mapColours
 * @param {Path[]} paths @param {number} current @param {string} title
 */
function drawn(view, bounds, mapColours, paths, current, title) {
  const ratio = (window.devicePixelRatio || 1) * unit();
  const label = `${title}: ${paths.map(({ person, people }) => ngettext("person {person} in {n} frame", "person {person} in {n} frames", people.length, { person })).join(", ")}`;
  /** @type {HTMLCanvasElement} */
  const canvas = element("canvas", {
    width: SIZE.width * ratio,
    height: SIZE.height * ratio,
    role: "img",
    "aria-label": label,
  });
  const ctx = canvas.getContext("2d");
  if (!ctx) throw new TypeError("this browser draws nothing");
  ctx.scale(ratio, ratio);
  const transform = bounds ? focus(bounds, SIZE, 1, Infinity) : fit(view.size, SIZE);
  view.paintBackground(ctx, transform, null, { mapColours, footprints: false });
  paths.forEach((path, index) =>
    drawPerson(ctx, view, transform, path, current, COLOURS[index % COLOURS.length], DASHES[index % DASHES.length]),
  );
  return canvas;
}

/**
 * @param {CanvasRenderingContext2D} ctx @param {MapView} view @param {import("../../views/transform.js").Transform} transform
 * @param {Path} path @param {number} current @param {string} colour @param {number[]} dash
 */
function drawPerson(ctx, view, transform, { person, people }, current, colour, dash) {
  const points = people.map(({ number, one }) => {
    const { x, y } = view.foot(one);
    return { number, one, ...transform.toPane(x, y) };
  });
  drawPath(ctx, points, { colour, dash });
  for (const { number, one, x, y } of points) {
    drawFoot(ctx, x, y, { colour, dash: one.state === "carried" ? [1] : [] }, number === current ? 4.5 : 2.5);
  }
  const end = points.at(-1);
  if (end) drawLabel(ctx, end.x, end.y - 6, String(person), { colour, selected: false });
}
