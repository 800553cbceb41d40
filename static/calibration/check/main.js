import { pageJson, required, setText } from "../../base/dom.js";
import { paintSoon } from "../../base/repaint.js";
import { DeskPage, holdUntilSaved } from "../desk_page.js";
import { listenToButtons, listenToKeys } from "../keys.js";
import { Magnifier } from "../magnifier.js";
import { drawSummary, List } from "./list.js";
import { Pane } from "./pane.js";
import { Panel } from "./panel.js";
import { Store } from "./store.js";

/** @typedef {import("../picture.js").XY} XY */

const page = required(document, "[data-check]", HTMLElement);
const given = pageJson("check");
const desk = new DeskPage(page, given.api, "check", "kept/");
const part = (/** @type {string} */ name) => desk.part(name);
const store = new Store(given.check, desk.saver);
const magnifier = new Magnifier();
const panel = new Panel(part("panel"), store);
const list = new List(part("kept"), store);
const panes = store.all.map((camera) => new Pane(camera, camera.full && desk.server.picture(camera.full), given.desk));
/** @type {{lines: boolean, hovered: number|null, hover: XY|null, large: boolean}} */
const view = { lines: true, hovered: null, hover: null, large: false };
const name = required(page, "[data-name]", HTMLInputElement);
const against = required(page, "[data-against]", HTMLSelectElement);
const filter = required(page, "[data-filter]", HTMLSelectElement);
const painter = { paint };

function paint() {
  const { point } = store;
  layOut(); // before drawing: marks are as large on the screen whatever the size of their pane
  panes.forEach((pane, index) => pane.draw(store, index === store.active, view.lines));
  magnify();
  panel.draw();
  list.draw();
  drawSummary(part("summary"), store);
  desk.showSteps(store.steps);
  setText(part("now"), point ? point.name : store.draft.empty ? "–" : "new");
  setText(part("hint"), hint());
  part("of-point").hidden = !point;
  if (document.activeElement !== name) name.value = point?.name ?? "";
  for (const [use, words] of [
    ["test", "test point"],
    ["correspondence", "correspondence"],
  ]) {
    const button = required(page, `[data-do=${use}]`, HTMLButtonElement);
    button.disabled = point ? point.use === use : Object.keys(store.draft.clicks).length < 2;
    button.title = point ? `${point.name} becomes a ${words}` : `Keep it as a ${words}`;
  }
}

function hint() {
  const count = Object.keys(store.clicks).length;
  if (store.cameras.size < 2)
    return "Two cameras must be calibrated before anything can be checked; the pictures say what is missing.";
  if (store.point) return "Click to move its clicks or to add one; Esc leaves it.";
  if (count === 0) return "Click the same thing in two pictures or more: a corner, a lamp, the foot of a post.";
  return count === 1
    ? "It lies on the line in the other pictures: click it there."
    : "The cross is where every picture must show it.";
}

function layOut() {
  const grid = part("panes");
  const columns = view.large ? Math.max(panes.length - 1, 1) : Math.ceil(Math.sqrt(panes.length));
  grid.style.setProperty("--columns", String(columns));
  grid.classList.toggle("has-large", view.large);
  panes.forEach((pane, index) => pane.element.classList.toggle("large", view.large && index === store.active));
}

function magnify() {
  const index = view.hover ? (view.hovered ?? store.active) : store.active;
  const pane = panes[index];
  if (!pane) return;
  if (part("magnifier").dataset.camera !== pane.camera.name) magnifier.show(pane.shown);
  part("magnifier").dataset.camera = pane.camera.name;
  magnifier.at(pane.shown ? (view.hover ?? pane.place(store)) : null);
}

/** @param {"undo"|"redo"} what */
async function step(what) {
  if (store.step(what)) return;
  const whole = await desk.step(what);
  if (whole) store.replace(whole);
}

/** @type {{[name: string]: () => void}} */
const actions = {
  undo: () => void step("undo"),
  redo: () => void step("redo"),
  clear: () => store.clear(),
  back: () => store.takeBack(),
  remove: () => store.remove(),
  test: () => keep("test"),
  correspondence: () => keep("correspondence"),
  closer: () => panes.forEach((pane) => void pane.closer(store)),
  fit: () => panes.forEach((pane) => void pane.picture.fit()),
  large: () => {
    view.large = !view.large;
    paintSoon(painter);
  },
  lines: () => {
    view.lines = !view.lines;
    paintSoon(painter);
  },
};
/** @type {{[key: string]: string}} */
const names = {
  Escape: "clear",
  Backspace: "back",
  Delete: "remove",
  k: "correspondence",
  t: "test",
  l: "large",
  z: "closer",
  f: "fit",
  e: "lines",
};

/** @param {import("./store.js").Use} use */
function keep(use) {
  if (!store.point && Object.keys(store.draft.clicks).length < 2)
    return desk.tell("Click the thing in a second picture to keep it.");
  desk.tell("");
  store.keep(use);
}

/** The magnifier shows what is nudged. @param {number} dx @param {number} dy */
function nudge(dx, dy) {
  view.hover = null;
  store.nudge(dx, dy);
}

/** @param {number} index */
function choose(index) {
  if (!panes[index]) return false;
  view.hover = null;
  store.activate(index);
  return true;
}

part("magnifier").append(magnifier.element);
listenToKeys({ actions, names, nudge, choose });
listenToButtons(page, actions);

panes.forEach((pane, index) => {
  part("panes").append(pane.element);
  pane.on("click", ({ x, y }) => store.click(index, x, y));
  pane.on("hover", (place) => {
    view.hovered = index;
    view.hover = place;
    magnify();
  });
  pane.on("view", () => paintSoon(painter));
});
name.addEventListener("change", () => {
  store.rename(name.value.trim());
  name.blur();
});
filter.addEventListener("change", () => {
  list.filter = filter.value;
  paintSoon(painter);
});
against.addEventListener("change", () => store.look(against.value === "in_place" ? "in_place" : "placed"));
part("against-label").hidden = !store.all.some((camera) => camera.in_place);
against.value = store.against;

store.on("changed", () => paintSoon(painter));
desk.saver.on("refused", () => void reload());
holdUntilSaved(desk.saver);
new ResizeObserver(() => paintSoon(painter)).observe(part("panes"));
if (store.kept.some((each) => each.name === given.point)) store.select(given.point);
paintSoon(painter);

/** What was shown already is not what the server has. */
async function reload() {
  const whole = await desk.server.ask("GET", desk.path).catch(() => null);
  if (whole && desk.saver.idle) store.replace(whole);
}
