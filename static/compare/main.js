import { Api } from "../base/api.js";
import { pageJson, required } from "../base/dom.js";
import { problemWords } from "../base/failure_words.js";
import { gettext } from "../base/messages.js";
import { Notices } from "../base/notices.js";
import { opening } from "../base/opening.js";
import { fetchTables, openScene } from "../tables/tables.js";
import { Images } from "../views/images.js";
import { CompareStore } from "./store.js";
import { buildViewer } from "./viewer.js";

/** @typedef {{scene: string, truth: string, found: string, frames: import("./store.js").Line[]}} Comparison */

const root = required(document, "#viewer", HTMLElement);
/** @type {Comparison} */
const comparison = pageJson("comparison");
const { scene: base, truth, found, frames } = comparison;
const { home = "", marks = "" } = document.body.dataset;

await opening(root, start, { title: gettext("The comparison could not be shown"), home: home });

async function start() {
  const api = new Api({ base, token: "", mode: "layer", csrf: "" });
  const answer = await api.scene();
  const images = new Images(api, answer);
  const store = new CompareStore(frames);
  if (window.location.hash) store.open(Number(window.location.hash.slice(1)));
  images.want([store.current]);
  const scene = await openScene(
    api,
    answer,
    () => images.settled(store.current),
    (words) => (root.textContent = words),
  );
  const notices = new Notices();
  store.on("frame", () => {
    window.history.replaceState(null, "", `#${store.current}`);
    look(store, images).catch((error) => notices.say(problemWords(error)));
  });
  buildViewer(root, { store, scene, images, names: { truth, found }, home });
  root.append(notices.element);
  await look(store, images);
  fetchTables({ api, scene, images }, store.current);
}

/**
 * The frame looked at first, then those one key away.
 * @param {CompareStore} store @param {Images} images
 */
async function look(store, images) {
  const wanted = [store.current, store.neighbour(1), store.neighbour(-1), store.neighbour(1, store.inTime)];
  images.want([...new Set(wanted)]);
  for (const number of new Set(wanted)) {
    if (!store.has(number)) store.put(number, await marksOf(number));
  }
}

/** @param {number} number @returns {Promise<import("./store.js").MarkJSON[]>} */
async function marksOf(number) {
  const response = await fetch(marks.replace("/frames/0/", `/frames/${number}/`), { cache: "no-store" });
  if (!response.ok) throw new Error(gettext("The server did not answer; load the page again."));
  return (await response.json()).marks;
}
