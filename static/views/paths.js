/**
 * Where people walk: a line through their positions over the frames, in the views and on the map. Between two
 * validated positions it is solid, otherwise dashed; over frames without the person it is dotted.
 * @typedef {import("../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../truth/store.js").Store} Store
 * @typedef {import("./pane.js").LaidOutPane} LaidOutPane
 * @typedef {import("./regions.js").XY} XY
 * @typedef {"validated"|"carried"|"missing"} Kind of a step: solid, dashed, dotted
 * @typedef {{number: number, annotation: Annotation}} Step
 * @typedef {import("./regions.js").Item & {person: number, steps: Step[], selected: boolean,
 *            transform: import("./transform.js").Transform}} PathItem
 */
import { VALIDATED } from "../truth/annotation.js";
import { drawPath } from "./marks.js";
import { CYAN, WHITE, YELLOW } from "./styles.js";

const REACH = 15; // frames before and after the open one
const ROOM = 6; // CSS pixels a line with its dots reaches beyond its points

const STYLES = {
  validated: { dash: [], width: 1.5 },
  carried: { dash: [6, 4], width: 1.5 },
};

/**
 * Frames around the open one in which a person is, in order. Pure.
 * @param {Store} store @param {number} person @returns {Step[]}
 */
export function trail(store, person) {
  const index = store.numbers.indexOf(store.current);
  return store.numbers.slice(Math.max(0, index - REACH), index + REACH + 1).flatMap((number) => {
    const annotation = store.person(person, number);
    return annotation ? [{ number, annotation }] : [];
  });
}

/**
 * Whether two steps of a trail are joined by a solid, a dashed or a dotted line. Pure.
 * @param {Store} store @param {Step} from @param {Step} to @returns {Kind}
 */
export function kindOfStep(store, from, to) {
  const apart = store.numbers.indexOf(to.number) - store.numbers.indexOf(from.number);
  if (apart > 1) return "missing";
  const both = from.annotation.state === VALIDATED && to.annotation.state === VALIDATED;
  return both ? "validated" : "carried";
}

/** Makes items for `Panes.addExtra`; an item lives as long as what it shows stays the same. */
export class Paths {
  /** @param {import("./panes.js").Panes} panes @param {import("../workbench/settings.js").Settings} settings */
  constructor(panes, settings) {
    this.panes = panes;
    this.store = panes.store;
    this.settings = settings;
    /** @type {Map<LaidOutPane, Map<number, PathItem>>} */
    this._known = new Map(); // items by person
    panes.addExtra((pane) => this.items(pane));
    settings.on("change", ({ name }) => name.startsWith("paths") && panes.markPeople());
    this.store.on("change", () => panes.markPeople()); // a filled-in frame elsewhere is part of the path here
  }

  /** @param {LaidOutPane} pane @returns {PathItem[]} */
  items(pane) {
    const known = this._known.get(pane) ?? new Map();
    /** @type {Map<number, PathItem>} */
    const items = new Map();
    for (const person of this._shown(pane)) {
      const steps = trail(this.store, person);
      if (steps.length < 2) continue;
      const old = known.get(person);
      items.set(person, old && this._isSame(old, steps, pane) ? old : this._item(pane, person, steps));
    }
    this._known.set(pane, items);
    return [...items.values()];
  }

  /** @param {LaidOutPane} pane @returns {Iterable<number>} */
  _shown(pane) {
    const wanted = this.settings.get(pane.view.index === null ? "pathsOnMap" : "pathsInViews");
    const { selection } = this.store;
    if (wanted === "all") return this._everybody();
    return wanted === "selected" && selection !== null ? [selection] : [];
  }

  /** Of the open frame, and of the others in reach. */
  _everybody() {
    const index = this.store.numbers.indexOf(this.store.current);
    const near = this.store.numbers.slice(Math.max(0, index - REACH), index + REACH + 1);
    return new Set(near.flatMap((number) => [...this.store.people(number).keys()]));
  }

  /** @param {PathItem} item @param {Step[]} steps @param {LaidOutPane} pane */
  _isSame(item, steps, pane) {
    return (
      item.transform === pane.transform &&
      item.selected === (item.person === this.store.selection) &&
      item.steps.length === steps.length &&
      steps.every(
        ({ annotation, number }, index) =>
          annotation === item.steps[index].annotation && number === item.steps[index].number,
      )
    );
  }

  /** @param {LaidOutPane} pane @param {number} person @param {Step[]} steps @returns {PathItem} */
  _item(pane, person, steps) {
    const selected = person === this.store.selection;
    const points = steps.map(({ annotation }) => placeOn(pane, annotation));
    const seen = points.filter((point) => point !== null);
    const [xs, ys] = [seen.map(({ x }) => x), seen.map(({ y }) => y)];
    return {
      id: `path ${person}`,
      what: steps,
      look: "",
      person,
      steps,
      selected,
      transform: pane.transform,
      bounds: {
        xmin: Math.min(...xs) - ROOM,
        ymin: Math.min(...ys) - ROOM,
        xmax: Math.max(...xs) + ROOM,
        ymax: Math.max(...ys) + ROOM,
      },
      draw: (ctx) => this._draw(ctx, steps, points, selected),
    };
  }

  /** @param {CanvasRenderingContext2D} ctx @param {Step[]} steps @param {(XY|null)[]} points @param {boolean} selected */
  _draw(ctx, steps, points, selected) {
    for (let index = 1; index < points.length; index += 1) {
      const [from, to] = [points[index - 1], points[index]];
      if (!from || !to) continue; // behind the camera
      const kind = kindOfStep(this.store, steps[index - 1], steps[index]);
      const colour = selected ? CYAN : kind === "carried" ? YELLOW : WHITE;
      if (kind === "missing") drawDotted(ctx, from, to, colour);
      else drawPath(ctx, [from, to], { ...STYLES[kind], colour });
    }
    points.forEach((point, index) => point && drawDot(ctx, point, steps[index].annotation, selected));
  }
}

/** @param {LaidOutPane} pane @param {Annotation} annotation @returns {XY|null} */
function placeOn(pane, annotation) {
  const foot = pane.view.foot(annotation);
  return foot && pane.transform.toPane(foot.x, foot.y);
}

/**
 * Faint and without a rim: nobody said that the person went this way.
 * @param {CanvasRenderingContext2D} ctx @param {XY} from @param {XY} to @param {string} colour
 */
function drawDotted(ctx, from, to, colour) {
  ctx.beginPath();
  ctx.moveTo(from.x, from.y);
  ctx.lineTo(to.x, to.y);
  ctx.setLineDash([1.5, 5]);
  ctx.lineWidth = 1.25;
  ctx.strokeStyle = colour;
  ctx.stroke();
  ctx.setLineDash([]);
}

/** @param {CanvasRenderingContext2D} ctx @param {XY} place @param {Annotation} annotation @param {boolean} selected */
function drawDot(ctx, { x, y }, { state }, selected) {
  ctx.beginPath();
  ctx.arc(x, y, 2.25, 0, 2 * Math.PI);
  const colour = state === VALIDATED ? (selected ? CYAN : WHITE) : YELLOW;
  ctx.fillStyle = colour;
  ctx.fill();
}
