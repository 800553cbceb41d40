import { Actions } from "./actions.js";
import { Bar } from "./bar.js";
import { directionItems } from "./directions.js";
import { element } from "./dom.js";
import { Filmstrip } from "./filmstrip.js";
import { FrameHistory } from "./frame_history.js";
import { Hints } from "./hints.js";
import { IdentityActions } from "./identity_actions.js";
import { nameKeys } from "./key_sheet.js";
import { Keyboard } from "./keyboard.js";
import { useKeys } from "./keys.js";
import { Layout } from "./layout.js";
import { gettext } from "./messages.js";
import { Notices } from "./notices.js";
import { panelTools } from "./panel_tools.js";
import { Panes } from "./panes.js";
import { Paths } from "./paths.js";
import { PeoplePanel } from "./people_panel.js";
import { Playback } from "./playback.js";
import { Pointer } from "./pointer.js";
import { Round } from "./round.js";
import { DISPLAYED, Settings } from "./settings.js";
import { TimeActions } from "./time_actions.js";
import { Timeline } from "./timeline.js";
import { UndoActions } from "./undo_actions.js";
import { Views } from "./views.js";
import { ViewsMenu } from "./views_menu.js";
import { Walk } from "./walk.js";
import { WarningActions } from "./warning_actions.js";
import { warningItems } from "./warning_marks.js";
import { Warnings } from "./warnings.js";
import { WarningsPanel } from "./warnings_panel.js";

/**
 * Builds the page over a session inside `root` and connects its parts.
 * @param {import("./session.js").Session} session
 * @param {{mode: string, home: string}} settings
 */
export function buildWorkbench(root, session, { mode, home }) {
  const { scene, store, images, activity } = session;
  const settings = new Settings();
  const panes = new Panes({ scene, store, images, settings, options: startOptions() });
  panes.addExtra((pane) => directionItems(panes, pane));
  settings.on("change", () => panes.markPeople(true));
  const notices = new Notices();
  const walk = new Walk({ ...session, notices, finish: () => finish({ ...session, walk, notices, home }) });
  const actions = new Actions({ ...session, settings, panes, notices, walk });
  const identity = new IdentityActions({ ...session, panes, notices, guard: actions.guard });
  actions.use(identity.table());
  actions.use(new UndoActions({ ...session, notices, guard: actions.guard }).table());
  const playback = new Playback({ ...session, walk, settings });
  actions.use(new TimeActions({ ...session, settings, panes, notices, guard: actions.guard, walk, playback }).table());
  actions.use(new Round({ store, panes, notices, walk, actions }).table());
  new Paths(panes, settings);
  const perform = (id, event) => {
    activity.note(store.current);
    if (id !== "play") playback.stop();
    actions.perform(id, event);
  };
  const bar = new Bar({ ...session, panes, perform, home, signIn: signInAddress(mode, home) });
  const panel = new PeoplePanel({ scene, store, select: (person) => actions.select(person) });
  const stage = element("main", { className: "stage" });
  const filmstrip = new Filmstrip({ ...session, walk, panes, settings });
  const timeline = new Timeline({ ...session, walk, playback, perform });
  root.replaceChildren(bar.element, stage, filmstrip.element, timeline.element, notices.element);
  actions.pointer = new Pointer(panes, actions);
  connectKeyboard(actions, bar, perform, settings);
  const layout = new Layout(stage, panes, panel.element, scene.cameras[0].width / scene.cameras[0].height);
  chooseViews(root, actions, { panes, layout, settings, notices });
  if (mode === "tutorial") startTutorial(panel, { ...session, panes, walk, home });
  else {
    const frameHistory = new FrameHistory({ ...session, panes, notices, guard: actions.guard });
    actions.use(frameHistory.table());
    const list = warn(session, { settings, panes, notices, walk, actions, identity });
    panel.element.append(panelTools(store, perform, actions.heads), list, frameHistory.element, new Hints({ store, panes, settings }).element);
  }
  watch(session, panes, notices);
  walk.carryInto(store.current);
}

// What few need, and nobody without the server, is fetched when it is needed.

async function finish(parts) {
  const { finishAssignment } = await import("./finish.js");
  return finishAssignment(parts);
}

async function ask(scene, store, conflict) {
  const { askAboutConflicts } = await import("./conflicts.js");
  return askAboutConflicts(scene, store, conflict);
}

async function startTutorial(panel, parts) {
  const { Tutorial } = await import("./tutorial.js");
  const tutorial = new Tutorial(parts);
  panel.element.prepend(tutorial.element);
  tutorial.start();
}

/** F6 gives Tab, Space and Enter to the buttons; Escape takes them back. */
function connectKeyboard(actions, bar, perform, settings) {
  const keyboard = new Keyboard(perform, (controls) => bar.showMode(controls));
  settings.watch("keys", (keys) => {
    useKeys(keys);
    keyboard.learn();
    nameKeys(document);
  });
  actions.setControls = (on) => {
    keyboard.setControls(on);
    if (on) bar.element.querySelector("a, button").focus();
    else document.activeElement?.blur();
  };
}

/** What is seen and how, as it was chosen last. */
function chooseViews(root, actions, { panes, layout, settings, notices }) {
  const views = new Views({ panes, layout, settings, notices });
  const menu = new ViewsMenu(views);
  root.append(menu.element);
  actions.views = views;
  actions.use({ ...views.table(), views: () => menu.toggle() });
  for (const name of DISPLAYED) settings.watch(name, (value) => panes.set(name, value));
}

/** @returns {HTMLElement} the list of warnings; the same warnings are drawn in the panes */
function warn(session, { settings, panes, notices, walk, actions, identity }) {
  const { store } = session;
  const warnings = new Warnings(session);
  const acting = new WarningActions({ store, warnings, walk, notices, identity });
  actions.use(acting.table());
  panes.addExtra((pane) => warningItems(warnings, panes, pane));
  warnings.on("change", () => panes.markPeople());
  return new WarningsPanel({ store, warnings, settings, go: (one) => acting.go(one), join: (one) => acting.join(one) }).element;
}

/** Things that happen outside the page's own controls. */
function watch({ saver, store, scene, images, activity }, panes, notices) {
  let asking = Promise.resolve();
  const askInTurn = (conflict) => {
    asking = asking.then(async () => saver.resolve(conflict.frame, await ask(scene, store, conflict)));
  };
  saver.conflicts().forEach(askInTurn);
  saver.on("conflict", askInTurn);
  saver.on("renumber", ({ from, to }) =>
    notices.say(gettext("Person {from} is {to} now: somebody else had taken the number meanwhile", { from, to })),
  );
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

function startOptions() {
  return { outline: false, directions: false, grid: false, labelOpacity: 1, boxOpacity: 1, mapColours: mapColours() };
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

/** Where signing in again leads back to: staff log in, workers have their own page. */
function signInAddress(mode, home) {
  return mode === "layer" ? `/login/?next=${encodeURIComponent(home)}` : home;
}
