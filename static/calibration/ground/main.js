import { element, pageJson, required, setText } from "../../base/dom.js";
import { paintSoon } from "../../base/repaint.js";
import { DeskPage, holdUntilSaved } from "../desk_page.js";
import { listenToButtons, listenToKeys } from "../keys.js";
import { Magnifier } from "../magnifier.js";
import { Picture } from "../picture.js";
import { marks } from "./marks.js";
import { legend, Panel } from "./panel.js";
import { Store } from "./store.js";

/** @typedef {import("../picture.js").XY} XY */

const page = required(document, "[data-ground]", HTMLElement);
const given = pageJson("ground");
const desk = new DeskPage(page, given.api, "ground", "ground/");
const { server } = desk;
const part = (/** @type {string} */ name) => desk.part(name);
const store = new Store(given.ground, desk.saver);
const picture = new Picture("The ground as this camera sees it");
const magnifier = new Magnifier();
const panel = new Panel(part("panel"), store);
/** @type {{grid: boolean, hover: XY|null, moved: boolean}} */
const view = { grid: true, hover: null, moved: false };

part("picture").prepend(picture.element);
part("magnifier").append(magnifier.element);

const painter = { paint };

function paint() {
  const { camera, ground } = store;
  page.dataset.camera = camera?.name ?? "";
  setText(part("now"), store.selected ?? "–");
  picture.marks.replaceChildren(...marks(store, picture.unit, view.grid));
  magnifier.at(view.hover ?? store.place);
  panel.draw();
  legend(part("legend"), view.grid);
  desk.showSteps(ground);
  cameras();
}

function cameras() {
  const buttons = [...part("cameras").querySelectorAll("button")];
  store.ground.cameras.forEach((camera, index) => {
    buttons[index].setAttribute("aria-pressed", String(index === store.index));
    const { rms } = camera.report;
    const count = Object.keys(camera.clicks).length;
    setText(
      required(buttons[index], "small", HTMLElement),
      rms === undefined || rms === null ? `${count} clicked` : `${rms.toFixed(2)} px`,
    );
  });
}

function showCamera() {
  const { camera } = store;
  const shown = camera?.full ? { href: server.picture(camera.full), width: camera.width, height: camera.height } : null;
  picture.show(shown);
  magnifier.show(shown);
  part("empty").hidden = Boolean(shown);
  for (const field of document.querySelectorAll("[data-of-camera]"))
    if (field instanceof HTMLInputElement) field.value = camera?.name ?? "";
  for (const word of document.querySelectorAll("[data-camera-name]")) setText(word, camera?.name ?? "");
}

/** @param {"undo"|"redo"} what */
async function step(what) {
  const whole = await desk.step(what);
  if (!whole) return;
  store.replace(whole);
  showCamera();
}

/** @param {number} index */
function lookThrough(index) {
  store.selectCamera(index);
  showCamera();
  picture.fit();
}

function confirmByKey() {
  store.confirm();
  view.hover = null;
}

function closer() {
  if (store.place) picture.lookAt(store.place, store.camera.width / 6);
}

/** @type {{[name: string]: () => void}} */
const actions = {
  undo: () => void step("undo"),
  redo: () => void step("redo"),
  confirm: () => store.confirm(),
  remove: () => store.remove(),
  next: () => store.selectNext(1),
  previous: () => store.selectNext(-1),
  grid: () => {
    view.grid = !view.grid;
    paintSoon(painter);
  },
  fit: () => picture.fit(),
  closer,
};
/** @type {{[key: string]: string}} */
const names = {
  Enter: "confirm",
  Delete: "remove",
  Backspace: "remove",
  n: "next",
  p: "previous",
  g: "grid",
  f: "fit",
  z: "closer",
};

/** The magnifier shows what is nudged. @param {number} dx @param {number} dy */
function nudge(dx, dy) {
  view.hover = null;
  store.nudge(dx, dy);
}

/** @param {number} index */
function choose(index) {
  if (!store.ground.cameras[index]) return false;
  lookThrough(index);
  return true;
}

listenToKeys({ actions: { ...actions, confirm: confirmByKey }, names, nudge, choose });
listenToButtons(page, actions);

store.ground.cameras.forEach((camera, index) => {
  const image = camera.light ? element("img", { src: server.picture(camera.light), alt: "", loading: "lazy" }) : null;
  const words = element("span", {}, camera.name, element("small", { className: "muted" }));
  part("cameras").append(element("button", { type: "button", onclick: () => lookThrough(index) }, image, words));
});
picture.on("click", ({ x, y }) => store.click(x, y, picture.unit));
picture.on("hover", (place) => {
  view.hover = place;
  magnifier.at(place ?? store.place);
});
picture.on("view", () => paintSoon(painter));
store.on("changed", () => paintSoon(painter));
store.on("moved", () => paintSoon(painter));
desk.saver.on("refused", () => paintSoon(painter));
holdUntilSaved(desk.saver);
new ResizeObserver(() => paintSoon(painter)).observe(picture.element);

const asked = store.ground.cameras.findIndex(({ name }) => name === given.camera);
if (asked > 0) lookThrough(asked);
showCamera();
paintSoon(painter);
