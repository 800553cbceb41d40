/** What a patch over several frames changes: in words, frame by frame, and as paths on a map before and after. */
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
const DASHES = [[], [7, 3], [2, 3], [9, 3, 2, 3]];

/** @returns {{places: [number, number], changes: string[]}[]} runs of frames, by their place from 1, with the same changes */
export function changesOf(store, patch) {
  const runs = [];
  store.numbers.forEach((number, index) => {
    const changes = frameChanges(patch.edits.filter((edit) => edit.frame === number && !edit.flags));
    if (!changes.length) return;
    const last = runs.at(-1);
    if (last && last.places[1] === index && last.changes.join() === changes.join()) last.places[1] = index + 1;
    else runs.push({ places: [index + 1, index + 1], changes });
  });
  return runs;
}

export function changeList(store, patch) {
  const items = changesOf(store, patch).map(({ places: [from, to], changes }) => {
    const where = from === to ? gettext("Frame {place}", { place: from }) : gettext("Frames {from}–{to}", { from, to });
    return element("li", {}, element("strong", {}, where), `: ${changes.join("; ")}`);
  });
  return element("ul", { className: "change-list", tabIndex: 0, "aria-label": gettext("What changes") }, items);
}

/** Two maps, before and after, of everybody the patch touches and of `others` who matter beside them. */
export function beforeAndAfter(scene, store, mapColours, patch, others = []) {
  const edits = patch.edits.filter((edit) => !edit.flags);
  const concerned = new Set([...edits.map(({ person }) => person), ...others.filter((person) => person !== null)]);
  const persons = [...concerned].sort((one, other) => one - other);
  const before = pathsOf(store, persons, new Map());
  const after = pathsOf(store, persons, new Map(edits.map((edit) => [`${edit.frame} ${edit.person}`, edit.after])));
  const view = new MapView(scene, "");
  const bounds = boundsOf(
    view,
    [...before, ...after].flatMap(({ people }) => people),
  );
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

/** "5 becomes 9": who leaves a number is looked for where it stood. */
function frameChanges(edits) {
  return edits
    .filter(({ before }) => before)
    .map(({ person, before, after }) => {
      const now = edits.find((edit) => edit.after?.position === before.position);
      if (now && now.person !== person) return gettext("{person} becomes {other}", { person, other: now.person });
      if (now) return gettext("{person} changes", { person });
      return after && !edits.some((edit) => edit.person !== person && edit.before?.position === after.position)
        ? gettext("{person} is filled in anew", { person })
        : gettext("{person} is removed", { person });
    });
}

/** @returns {{person, people: {number, one}[]}[]} in the order of frames, with the edits carried out */
function pathsOf(store, persons, edited) {
  return persons.map((person) => {
    const at = (number) =>
      edited.has(`${number} ${person}`) ? edited.get(`${number} ${person}`) : store.person(person, number);
    return { person, people: store.numbers.map((number) => ({ number, one: at(number) })).filter(({ one }) => one) };
  });
}

function boundsOf(view, people) {
  const points = people.map(({ one }) => view.foot(one));
  const box = points.reduce(
    (all, { x, y }) => union(all, { xmin: x - AROUND, ymin: y - AROUND, xmax: x + AROUND, ymax: y + AROUND }),
    null,
  );
  if (!box) return null;
  const grow = (low, high) => Math.max(0, SMALLEST - (high - low)) / 2;
  const [wide, high] = [grow(box.xmin, box.xmax), grow(box.ymin, box.ymax)];
  return { xmin: box.xmin - wide, xmax: box.xmax + wide, ymin: box.ymin - high, ymax: box.ymax + high };
}

function drawn(view, bounds, mapColours, paths, current, title) {
  const ratio = (window.devicePixelRatio || 1) * unit();
  const label = `${title}: ${paths.map(({ person, people }) => ngettext("person {person} in {n} frame", "person {person} in {n} frames", people.length, { person })).join(", ")}`;
  const canvas = element("canvas", {
    width: SIZE.width * ratio,
    height: SIZE.height * ratio,
    role: "img",
    "aria-label": label,
  });
  const ctx = canvas.getContext("2d");
  ctx.scale(ratio, ratio);
  const transform = bounds ? focus(bounds, SIZE, 1, Infinity) : fit(view.size, SIZE);
  view.paintBackground(ctx, transform, null, { mapColours, footprints: false });
  paths.forEach((path, index) =>
    drawPerson(ctx, view, transform, path, current, COLOURS[index % COLOURS.length], DASHES[index % DASHES.length]),
  );
  return canvas;
}

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
