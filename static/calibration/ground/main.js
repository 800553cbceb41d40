import { element, pageJson, required, setText } from "../../base/dom.js";
import { paintSoon } from "../../base/repaint.js";
import { Picture } from "../picture.js";
import { Saver } from "../saver.js";
import { Server } from "../server.js";
import { Magnifier } from "./magnifier.js";
import { marks } from "./marks.js";
import { legend, Panel } from "./panel.js";
import { Store } from "./store.js";

/** @typedef {import("../picture.js").XY} XY */

const page = required(document, "[data-ground]", HTMLElement);
const part = (/** @type {string} */ name) => required(page, `[data-${name}]`, HTMLElement);
const given = pageJson("ground");
const server = new Server(given.api, required(page, "[name=csrfmiddlewaretoken]", HTMLInputElement).value);
const saver = new Saver(server);
const store = new Store(given.ground, saver);
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
  for (const [name, what] of [
    ["undo", ground.undo],
    ["redo", ground.redo],
  ]) {
    const button = required(page, `[data-do=${name}]`, HTMLButtonElement);
    button.disabled = !what;
    button.title = what ? `${name === "undo" ? "Undo" : "Redo"}: ${what}` : "";
  }
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
  for (const field of page.querySelectorAll("[data-of-camera]"))
    if (field instanceof HTMLInputElement) field.value = camera?.name ?? "";
  for (const word of page.querySelectorAll("[data-camera-name]")) setText(word, camera?.name ?? "");
}

/** @param {string} text */
function tell(text) {
  part("problem").hidden = !text;
  setText(part("problem"), text);
}

function tellSaved() {
  setText(
    part("saved"),
    saver.idle
      ? "Everything is saved"
      : saver.stuck
        ? "Not saved yet: the server does not answer; trying again"
        : "Saving…",
  );
}

/** @param {"undo"|"redo"} what */
async function step(what) {
  if (!saver.idle) return;
  try {
    await server.ask("POST", `${what}/`, { page: "ground" });
    store.replace(await server.ask("GET", "ground/"));
    showCamera();
    tell("");
  } catch (error) {
    tell(error instanceof Error ? error.message : String(error));
  }
}

/** @param {number} index */
function lookThrough(index) {
  store.selectCamera(index);
  showCamera();
  picture.fit();
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
const KEYS = {
  Enter: "confirm",
  Delete: "remove",
  Backspace: "remove",
  n: "next",
  p: "previous",
  g: "grid",
  f: "fit",
  z: "closer",
};
/** @type {{[key: string]: number[]}} */
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** @param {KeyboardEvent} event @returns {boolean} whether the key meant something */
function press(event) {
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  if (event.ctrlKey || event.metaKey) {
    const wanted = key === "z" ? (event.shiftKey ? "redo" : "undo") : key === "y" ? "redo" : "";
    if (wanted) actions[wanted]();
    return Boolean(wanted);
  }
  if (ARROWS[key]) {
    const far = event.shiftKey ? 5 : 0.25;
    const [dx, dy] = ARROWS[key];
    view.hover = null; // the magnifier shows what is nudged
    store.nudge(far * dx, far * dy);
    return true;
  }
  const camera = Number(key);
  if (camera >= 1 && camera <= store.ground.cameras.length) lookThrough(camera - 1);
  else if (KEYS[key]) actions[KEYS[key]]();
  else return false;
  if (KEYS[key] === "confirm") view.hover = null;
  return true;
}

document.addEventListener("keydown", (event) => {
  const target = event.target instanceof Element ? event.target : null;
  if (event.altKey || target?.closest("input, select, textarea, dialog")) return;
  if (event.key === "Enter" && target?.closest("a, button, summary")) return;
  if (press(event)) event.preventDefault();
});
for (const button of page.querySelectorAll("[data-do]"))
  if (button instanceof HTMLElement) button.addEventListener("click", () => actions[button.dataset.do ?? ""]?.());

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
saver.on("state", tellSaved);
saver.on("answer", () => tell(""));
saver.on("refused", (text) => {
  tell(text);
  paintSoon(painter);
});
addEventListener("beforeunload", (event) => {
  if (!saver.idle) event.preventDefault();
});
new ResizeObserver(() => paintSoon(painter)).observe(picture.element);

const asked = store.ground.cameras.findIndex(({ name }) => name === given.camera);
if (asked > 0) lookThrough(asked);
showCamera();
tellSaved();
paintSoon(painter);
