import { element, setText } from "../base/dom.js";
import { chord } from "../base/key_press.js";
import { gettext } from "../base/messages.js";
import { mapColours, startOptions } from "../views/display.js";
import { Layout } from "../views/layout.js";
import { Panes } from "../views/panes.js";
import { Pointer } from "../views/pointer.js";
import { CompareIntents } from "./intents.js";
import { markItem } from "./marks.js";
import { MarksPanel } from "./panel.js";

/**
 * Builds the page inside `root`: the workbench's panes, with the marks of a comparison instead of people.
 * @typedef {import("../views/pane.js").LaidOutPane} LaidOutPane
 * @typedef {import("./store.js").CompareStore} CompareStore
 * @typedef {{truth: string, found: string}} Names of the two layers
 * @typedef {{store: CompareStore, scene: import("../truth/scene.js").Scene, images: import("../views/images.js").Images,
 *            names: Names, home: string}} Parts
 * @typedef {Record<string, () => void>} Actions by the key
 * @param {HTMLElement} root @param {Parts} parts
 */
export function buildViewer(root, { store, scene, images, names, home }) {
  const panes = new Panes({ scene, store, images, options: startOptions(), people: () => new Map() });
  panes.addExtra((pane) => items(pane, store, panes.options.labelOpacity > 0));
  store.on("marks", () => panes.markPeople());
  /** @param {number|null} key */
  const choose = (key) => {
    store.select(key);
    panes.zoom(key !== null);
  };
  /** @type {Actions} */
  const actions = {
    n: () => store.open(store.neighbour(1)),
    p: () => store.open(store.neighbour(-1)),
    ArrowRight: () => store.open(store.neighbour(1, store.inTime)),
    ArrowLeft: () => store.open(store.neighbour(-1, store.inTime)),
    Tab: () => choose(following(store)),
    l: () => panes.set("labelOpacity", panes.options.labelOpacity ? 0 : 1),
    Escape: () => choose(null),
  };
  const panel = new MarksPanel(store, names, choose);
  const stage = element("main", { className: "stage" });
  root.replaceChildren(bar(store, actions, names, home), stage);
  const layout = new Layout(stage, panes, panel.element, scene.cameras[0].width / scene.cameras[0].height);
  new Pointer(
    panes,
    new CompareIntents({ store, enlarge: (pane) => layout.setLarge(layout.large === pane ? null : pane) }),
  );
  document.addEventListener("keydown", (event) => onKey(event, actions));
  document.documentElement.addEventListener("themechange", () => panes.set("mapColours", mapColours()));
  window.addEventListener("focus", () => images.retryAll());
}

/**
 * Matched people first: mistakes are never hidden behind them.
 * @param {LaidOutPane} pane @param {CompareStore} store @param {boolean} labels
 */
function items(pane, store, labels) {
  return store
    .marks()
    .map((mark) => markItem(pane, mark, mark.key === store.selection, labels))
    .filter((item) => item !== null)
    .reverse();
}

/** @param {CompareStore} store */
function following(store) {
  /** @type {(number|null)[]} */
  const keys = store.marks().map(({ key }) => key);
  return keys.length ? keys[(keys.indexOf(store.selection) + 1) % keys.length] : null;
}

/** @param {KeyboardEvent} event @param {Actions} actions */
function onKey(event, actions) {
  const name = chord(event);
  if (!(name in actions)) return;
  event.preventDefault();
  actions[name]();
}

/** @param {CompareStore} store @param {Actions} actions @param {Names} names @param {string} home */
function bar(store, actions, names, home) {
  const place = element("span", { className: "place", role: "status" });
  const show = () =>
    setText(
      place,
      gettext("Frame {number} · {rank} of {count}, worst first", {
        number: String(store.current).padStart(8, "0"),
        rank: store.rank + 1,
        count: store.numbers.length,
      }),
    );
  store.on("frame", show);
  show();
  /** @param {string} key @param {string} words */
  const button = (key, words) =>
    element("button", { type: "button", onclick: () => actions[key]() }, words, " ", element("kbd", {}, key));
  return element(
    "header",
    { className: "bar" },
    element("a", { className: "home", href: home }, `← ${gettext("{found} against {truth}", names)}`),
    button("p", gettext("Previous")),
    place,
    button("n", gettext("Next")),
    element("span", { className: "gap" }),
    element(
      "span",
      { className: "left" },
      gettext("← → in time · Tab next person · Esc whole view · wheel zooms · double click: one view large"),
    ),
    button("l", gettext("Labels")),
  );
}
