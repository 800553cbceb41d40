import { Actions } from "./actions.js";
import { Activity } from "./activity.js";
import { Api } from "./api.js";
import { Bar } from "./bar.js";
import { askAboutConflicts } from "./conflicts.js";
import { directionItems } from "./directions.js";
import { element } from "./dom.js";
import { finishAssignment } from "./finish.js";
import { History } from "./history.js";
import { Images } from "./images.js";
import { Journal } from "./journal.js";
import { Keyboard } from "./keyboard.js";
import { Layout } from "./layout.js";
import { Loader } from "./loader.js";
import { Notices } from "./notices.js";
import { Panes } from "./panes.js";
import { PeoplePanel } from "./people_panel.js";
import { Pointer } from "./pointer.js";
import { Saver } from "./saver.js";
import { Scene } from "./scene.js";
import { Store } from "./store.js";
import { Tutorial } from "./tutorial.js";
import { Walk } from "./walk.js";

/**
 * Builds the workbench inside `root` and connects its parts.
 * @param {{api: string, token: string, mode: string, home: string, csrf: string}} settings
 */
export async function startWorkbench(root, settings) {
  const api = new Api({ base: settings.api, token: settings.token, mode: settings.mode, csrf: settings.csrf });
  const scene = new Scene(await api.scene());
  const numbers = scene.frames.map(({ number }) => number);
  const store = new Store(numbers, scene.nextPerson);
  const journal = await Journal.open(scene.mode === "tutorial" ? null : `${scene.mode} ${scene.layer.id}`);
  const activity = new Activity();
  const saver = new Saver({ api, store, journal, activity, practice: scene.mode === "tutorial" });
  const history = new History(store);
  const loader = new Loader({ api, scene, saver, store });
  await loader.start(numbers[0]);
  if (!scene.editable) saver.makeReadOnly(scene.readOnlyReason);
  await recover(journal, saver, loader, history);

  const images = new Images(api, scene.frames);
  const panes = new Panes({ scene, store, images, options: startOptions() });
  panes.addExtra((pane) => directionItems(panes, pane));
  const notices = new Notices();
  const finish = () => finishAssignment({ store, saver, api, home: settings.home, jump: (number) => store.open(number), notices });
  const walk = new Walk({ scene, store, history, saver, images, notices, finish, load: (number, again) => loader.load(number, again) });
  const actions = new Actions({ scene, store, history, saver, panes, notices, walk });
  const perform = (id) => {
    activity.note(store.current);
    actions.perform(id);
  };
  const bar = new Bar({ scene, store, saver, panes, perform, jump: (number) => walk.jump(number), home: settings.home, signIn: signInAddress(settings) });
  const panel = new PeoplePanel({ scene, store, select: (person) => actions.select(person) });
  const stage = element("main", { className: "stage" });
  root.replaceChildren(bar.element, stage, notices.element);
  new Pointer(panes, actions);
  const keyboard = new Keyboard(perform, (controls) => bar.showMode(controls));
  actions.setControls = (on) => {
    keyboard.setControls(on);
    if (on) bar.element.querySelector("a, button").focus();
    else document.activeElement?.blur();
  };
  const aspect = scene.cameras[0].width / scene.cameras[0].height;
  new Layout(stage, panes, panel.element, aspect);
  if (scene.mode === "tutorial") panel.element.prepend(new Tutorial({ api, store, home: settings.home }).element);
  watch({ saver, store, scene, images, activity, panes });
  openFirst(store, walk);
  return { scene, store, history, saver, panes, actions, walk, images };
}

/** Edits the server never acknowledged, and the undo steps, as they were before a reload. */
async function recover(journal, saver, loader, history) {
  for (const record of await journal.recover()) {
    await loader.load(record.frame, false);
    saver.adopt(record);
    await journal.drop(record);
  }
  const stored = await journal.readHistory();
  if (stored) history.restore(stored);
  history.on("change", () => journal.writeHistory(() => history.dump()));
}

/** Things that happen outside the page's own controls. */
function watch({ saver, store, scene, images, activity, panes }) {
  saver.on("conflict", async (conflict) => saver.resolve(conflict.frame, await askAboutConflicts(scene, store, conflict)));
  const back = () => {
    saver.wake();
    images.retryAll();
  };
  window.addEventListener("online", back);
  window.addEventListener("focus", back);
  document.addEventListener("visibilitychange", () => document.visibilityState === "hidden" && saver.sendOnLeaving());
  window.addEventListener("pagehide", () => saver.sendOnLeaving());
  for (const name of ["pointermove", "pointerdown", "wheel"]) {
    document.addEventListener(name, () => activity.note(store.current), { passive: true });
  }
  document.documentElement.addEventListener("themechange", () => panes.set("mapColours", mapColours()));
}

/** Continue where one was: the first frame that is not done. */
function openFirst(store, walk) {
  const unfinished = store.numbers.find((number) => store.frame(number).loaded && !store.frame(number).done);
  if (unfinished !== undefined && unfinished !== store.current) walk.jump(unfinished);
}

function startOptions() {
  return { outline: false, directions: false, grid: false, labels: true, opacity: 1, mapColours: mapColours() };
}

function mapColours() {
  const style = getComputedStyle(document.documentElement);
  const value = (name) => style.getPropertyValue(name).trim();
  return {
    ground: value("--map-ground"),
    weak: value("--map-weak"),
    strong: value("--map-strong"),
    cameras: value("--map-cameras").split(","),
  };
}

function signInAddress({ mode, home }) {
  return mode === "layer" ? `/login/?next=${encodeURIComponent(home)}` : home;
}
