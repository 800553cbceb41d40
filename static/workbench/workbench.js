import { element } from "../base/dom.js";
import { fetched, fetchedDialog } from "../base/lazy.js";
import { gettext } from "../base/messages.js";
import { Notices } from "../base/notices.js";
import { mapColours, startOptions } from "../views/display.js";
import { Layout } from "../views/layout.js";
import { Panes } from "../views/panes.js";
import { Pointer } from "../views/pointer.js";
import { Views } from "../views/views.js";
import { Actions } from "./actions.js";
import { AnnotatingIntents } from "./annotating_intents.js";
import { Bar } from "./bar.js";
import { Navigation } from "./frames/navigation.js";
import { Playback } from "./frames/playback.js";
import { TimeActions } from "./frames/time_actions.js";
import { Timeline } from "./frames/timeline.js";
import { UndoActions } from "./frames/undo_actions.js";
import { KeyActions } from "./key_actions.js";
import { nameKeys } from "./keys/key_titles.js";
import { Keyboard } from "./keys/keyboard.js";
import { useKeys } from "./keys/keys.js";
import { IdentityActions } from "./people/identity_actions.js";
import { OneByOne } from "./people/one_by_one.js";
import { panelTools } from "./people/panel_tools.js";
import { PeopleActions } from "./people/people_actions.js";
import { PeoplePanel } from "./people/people_panel.js";
import { placingParts } from "./placing_parts.js";
import { DISPLAYED, Settings } from "./settings.js";
import { WarningActions } from "./warnings/warning_actions.js";
import { warningItems } from "./warnings/warning_marks.js";
import { Warnings } from "./warnings/warnings.js";
import { WarningsPanel } from "./warnings/warnings_panel.js";

/**
 * @typedef {import("../saving/session.js").Session} Session
 * @typedef {import("./actions.js").ActionTable} ActionTable
 * @typedef {import("./actions.js").Perform} Perform
 *
 * @typedef {object} Page
 * @property {Settings} settings
 * @property {Panes} panes
 * @property {Notices} notices
 * @property {Navigation} navigation
 *
 * @typedef {object} OtherParts
 * @property {(person: number|null) => void} select
 * @property {Playback} playback
 * @property {IdentityActions} identity
 * @property {Views} views
 * @property {(on: boolean) => void} setControls
 *
 * @typedef {ReturnType<typeof placingParts>} Placing
 * @typedef {Placing & OtherParts} Parts
 */

/**
 * Builds the page over a session inside `root` and connects its parts. What few need, and nobody without the
 * server, is fetched when it is needed. Parts that only some pages name are told when everything else is built.
 * @param {HTMLElement} root
 * @param {Session} session
 * @param {{mode: string, home: string}} page `home`: the address one came from
 */
export async function buildWorkbench(root, session, { mode, home }) {
  const { scene, store, images, activity } = session;
  const settings = new Settings();
  const panes = new Panes({ scene, store, images, options: startOptions() });
  settings.on("change", () => panes.markPeople(true));
  const notices = new Notices();
  /** @type {() => Promise<typeof import("./frames/finish.js")|null>} */
  const finishing = fetchedDialog(notices, import.meta.resolve("./frames/finish.js"));
  /** @returns {Promise<unknown>} */
  const finish = async () => (await finishing())?.finishAssignment({ ...session, navigation, notices, home });
  const navigation = new Navigation({ ...session, notices, finish });
  const page = { settings, panes, notices, navigation };
  const placing = placingParts(session, page);
  const { guard, heads, ghost } = placing;
  const playback = new Playback({ ...session, navigation, settings });
  const actions = new Actions();
  /** @type {Perform} */
  const perform = (id, event) => {
    activity.note(store.current);
    if (id !== "play") playback.stop();
    actions.perform(id, event);
  };
  const bar = new Bar({ ...session, panes, perform, home, signIn: signInAddress(mode, home) });
  /** @param {number|null} person */
  const select = (person) => {
    ghost.hide();
    store.select(person);
  };
  const panel = new PeoplePanel({ scene, store, select });
  const stage = element("main", { className: "stage" });
  const timeline = new Timeline({ ...session, navigation, playback, perform });
  root.replaceChildren(bar.element, stage, timeline.element, notices.element);
  const layout = new Layout(stage, panes, panel.element, scene.cameras[0].width / scene.cameras[0].height);
  const views = new Views({ panes, layout, settings, notices });
  const identity = new IdentityActions({ ...session, panes, notices, guard });
  const intents = fillTable(actions, session, page, {
    ...placing,
    select,
    playback,
    identity,
    views,
    setControls: connectKeyboard(bar, perform, settings),
  });
  actions.use(chooseViews(root, views, page));
  showPaths(session.store, page);
  showFilmstrip(timeline, notices, { ...session, navigation, panes, settings });
  const parts = { ...page, ...placing, panel: panel.element, perform, actions, intents };
  const proposing = scene.proposed ? propose(session, parts) : Promise.resolve(null);
  actions.use(sideBySide(session, { ...parts, proposing }));
  if (mode !== "tutorial") addForWork(panel, session, page, { actions, perform, identity, heads, guard });
  document.dispatchEvent(new CustomEvent("built", { detail: { panel, ...session, ...page } }));
  watch(session, panes, notices);
  navigation.carryInto(store.current);
  if (mode === "tutorial") await startTutorial(panel, { ...session, panes, navigation, home });
}

/**
 * What the tutorial does without: buttons about the person, warnings, hints, the frame's history.
 * @param {PeoplePanel} panel @param {Session} session @param {Page} page
 * @param {{actions: Actions, perform: Perform, identity: IdentityActions} & Pick<Placing, "heads"|"guard">} parts
 */
function addForWork(panel, session, page, { actions, perform, identity, heads, guard }) {
  const list = warn(session, { ...page, actions, identity });
  panel.element.append(panelTools(session.store, perform, heads), list);
  hint(panel, session.store, page);
  actions.use(frameHistory(panel, { ...session, ...page, guard }));
}

/**
 * Hints are about what somebody does, so they come with the first thing done; nobody misses one that does not arrive.
 * @param {PeoplePanel} panel @param {import("../truth/store.js").Store} store @param {Page} page
 */
function hint(panel, store, page) {
  /** @param {typeof import("./hints.js")} module */
  const make = ({ Hints }) => {
    const made = new Hints({ ...page, store });
    panel.element.append(made.element);
    return made;
  };
  const hints = fetched({ say() {} }, import.meta.resolve("./hints.js"), make);
  for (const name of /** @type {const} */ (["selection", "frame", "change"])) store.on(name, hints);
  page.panes.element.addEventListener("wheel", async () => (await hints())?.zoomed(), { passive: true });
}

/**
 * What keys, buttons and the pointer do. Going one by one means something else by some of the keys, so it comes last.
 * @param {Actions} actions @param {Session} session @param {Page} page @param {Parts} parts
 */
function fillTable(actions, session, page, parts) {
  const { panes } = page;
  const intents = new AnnotatingIntents({ ...session, ...parts, enlarge: (pane) => parts.views.enlarge(pane) });
  const pointer = new Pointer(panes, intents);
  const people = new PeopleActions({ ...session, ...page, ...parts });
  const keys = new KeyActions({ ...session, ...page, ...parts, intents, pointer });
  for (const topic of [parts.moving, parts.sizes, people, keys, parts.identity]) actions.use(topic.table());
  actions.use(new UndoActions({ ...session, ...page, ...parts }).table());
  actions.use(new TimeActions({ ...session, ...page, ...parts }).table());
  actions.use(new OneByOne({ ...session, ...page, ...parts, intents, people, otherwise: () => keys.escape() }).table());
  return intents;
}

/**
 * People whom programs propose, drawn over the views; where they do not arrive the page works as if there were none.
 * @param {Session} session @param {import("./proposals/start.js").Page} page
 * @returns {ReturnType<typeof import("./proposals/start.js").startProposals>}
 */
async function propose(session, page) {
  /** @param {typeof import("./proposals/start.js")} part */
  const make = ({ startProposals }) => startProposals(session, page);
  return fetched(page.notices, import.meta.resolve("./proposals/start.js"), make)();
}

/**
 * Rows for the table of actions: everybody of a frame side by side.
 * @param {Session} session @param {import("./sheet/start.js").Page} page @returns {ActionTable}
 */
function sideBySide(session, page) {
  /** @param {typeof import("./sheet/start.js")} part */
  const make = ({ startSheet }) => startSheet(session, page);
  const sheet = fetched(page.notices, import.meta.resolve("./sheet/start.js"), make);
  return { sheet: async () => (await sheet())?.toggle() };
}

/**
 * @param {PeoplePanel} panel
 * @param {Session & {panes: Panes, navigation: Navigation, home: string}} parts
 */
async function startTutorial(panel, parts) {
  const { Tutorial } = await import("./tutorial/tutorial.js"); // without it the page is not started: main.js says so
  const tutorial = new Tutorial(parts);
  panel.element.prepend(tutorial.element);
  tutorial.start();
}

/**
 * Paths are of people who were chosen, or of everybody for those who like that.
 * @param {import("../truth/store.js").Store} store @param {Page} page
 */
function showPaths(store, { settings, panes, notices }) {
  /** @param {typeof import("../views/paths.js")} module */
  const make = ({ Paths }) => {
    new Paths(panes, settings);
    panes.markPeople();
    return true;
  };
  const paths = fetched(notices, import.meta.resolve("../views/paths.js"), make);
  store.on("selection", paths);
  settings.on("change", ({ name }) => name.startsWith("paths") && paths());
  if (settings.get("pathsOnMap") === "all" || settings.get("pathsInViews") === "all") paths();
}

/**
 * A strip that does not arrive is switched off, so that the next press tries again.
 * @param {Timeline} timeline @param {Notices} notices
 * @param {Session & Pick<Page, "navigation"|"panes"|"settings">} parts
 */
function showFilmstrip(timeline, notices, parts) {
  const { settings } = parts;
  /** @param {typeof import("./frames/filmstrip.js")} module */
  const make = ({ Filmstrip }) => {
    const filmstrip = new Filmstrip(parts);
    timeline.element.before(filmstrip.element);
    return filmstrip;
  };
  const filmstrip = fetched(notices, import.meta.resolve("./frames/filmstrip.js"), make);
  settings.watch("filmstrip", async (shown) => {
    if (shown && !(await filmstrip())) settings.set("filmstrip", false);
  });
}

/**
 * Rows for the table of actions.
 * @param {PeoplePanel} panel @param {Session & Page & Pick<Placing, "guard">} parts @returns {ActionTable}
 */
function frameHistory(panel, parts) {
  /** @param {typeof import("./frames/frame_history.js")} module */
  const make = ({ FrameHistory }) => {
    const made = new FrameHistory(parts);
    panel.element.append(made.element);
    return made;
  };
  const history = fetched(parts.notices, import.meta.resolve("./frames/frame_history.js"), make);
  return { history: async () => (await history())?.toggle() };
}

/**
 * F6 gives Tab, Space and Enter to the buttons; Escape takes them back.
 * @param {Bar} bar @param {Perform} perform @param {Settings} settings
 * @returns {(on: boolean) => void} does so
 */
function connectKeyboard(bar, perform, settings) {
  const keyboard = new Keyboard(perform, (controls) => bar.showMode(controls));
  settings.watch("keys", (keys) => {
    useKeys(keys);
    keyboard.learn();
    nameKeys(document);
  });
  return (on) => {
    keyboard.setControls(on);
    if (on) bar.takeFocus();
    else if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
  };
}

/**
 * What is seen and how, as it was chosen last.
 * @param {HTMLElement} root @param {Views} views @param {Page} page
 * @returns {ActionTable} rows for the table of actions
 */
function chooseViews(root, views, { panes, settings, notices }) {
  /** @param {typeof import("../views/views_menu.js")} module */
  const make = ({ ViewsMenu }) => {
    const made = new ViewsMenu(views);
    root.append(made.element);
    return made;
  };
  const menu = fetched(notices, import.meta.resolve("../views/views_menu.js"), make);
  for (const name of DISPLAYED) settings.watch(name, (value) => panes.set(name, value));
  return { ...views.table(), views: async () => (await menu())?.toggle() };
}

/**
 * @param {Session} session @param {Page & {actions: Actions, identity: IdentityActions}} parts
 * @returns {HTMLElement} the list of warnings; the same warnings are drawn in the panes
 */
function warn(session, { settings, panes, notices, navigation, actions, identity }) {
  const { store } = session;
  const warnings = new Warnings(session);
  const acting = new WarningActions({ store, warnings, navigation, notices, identity });
  actions.use(acting.table());
  panes.addExtra((pane) => warningItems(warnings, panes, pane));
  warnings.on("change", () => panes.markPeople());
  return new WarningsPanel({ store, warnings, settings, go: (one) => acting.go(one), join: (one) => acting.join(one) })
    .element;
}

/**
 * Things that happen outside the page's own controls.
 * @param {Session} session @param {Panes} panes @param {Notices} notices
 */
function watch(session, panes, notices) {
  const { saver, store, journal, images, activity } = session;
  const askAgain = askAboutConflicts(session, notices);
  saver.on("renumber", ({ from, to }) =>
    notices.say(gettext("Person {from} is {to} now: somebody else had taken the number meanwhile", { from, to })),
  );
  const back = () => {
    saver.wake();
    images.retryAll();
    askAgain();
  };
  window.addEventListener("online", back);
  window.addEventListener("focus", back);
  const leave = () => {
    saver.sendOnLeaving();
    journal.hurry();
  };
  document.addEventListener("visibilitychange", () => document.visibilityState === "hidden" && leave());
  window.addEventListener("pagehide", leave);
  for (const name of ["pointermove", "pointerdown", "wheel"]) {
    document.addEventListener(name, () => activity.note(store.current), { passive: true });
  }
  document.documentElement.addEventListener("themechange", () => panes.set("mapColours", mapColours()));
}

/**
 * One question after the other.
 * @param {Session} session @param {Notices} notices
 * @returns {() => void} asks those again that could not be asked
 */
function askAboutConflicts({ saver, scene, store }, notices) {
  /** @typedef {ReturnType<typeof saver.conflicts>[number]} Question */
  /** @type {() => Promise<typeof import("../saving/conflicts.js")|null>} */
  const conflicts = fetched(notices, import.meta.resolve("../saving/conflicts.js"));
  /** @type {Question[]} */
  const waiting = [];
  let asking = Promise.resolve();
  /** @param {Question} conflict */
  const ask = async (conflict) => {
    const dialog = await conflicts();
    if (dialog) saver.resolve(conflict.frame, await dialog.askAboutConflicts(scene, store, conflict));
    else waiting.push(conflict);
  };
  /** @param {Question} conflict */
  const askInTurn = (conflict) => (asking = asking.then(() => ask(conflict)));
  saver.conflicts().forEach(askInTurn);
  saver.on("conflict", askInTurn);
  return () => waiting.splice(0).forEach(askInTurn);
}

/**
 * Where signing in again leads back to: staff log in, workers have their own page.
 * @param {string} mode @param {string} home
 */
function signInAddress(mode, home) {
  return mode === "layer" ? `${document.body.dataset.login}?next=${encodeURIComponent(home)}` : home;
}
