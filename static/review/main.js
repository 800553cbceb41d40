import { Api } from "../base/api.js";
import { pageJson, required } from "../base/dom.js";
import { fetchParts } from "../base/lazy.js";
import { gettext } from "../base/messages.js";
import { Notices } from "../base/notices.js";
import { opening } from "../base/opening.js";
import { fetchTables, openScene } from "../tables/tables.js";
import { Images } from "../views/images.js";
import { buildDesk } from "./desk.js";
import { DeskServer } from "./server.js";
import { DeskStore } from "./store.js";

const root = required(document, "#viewer", HTMLElement);
/** @type {import("./desk.js").Desk} */
const desk = pageJson("desk");

await opening(root, start, { title: gettext("The review could not be opened"), home: desk.home });

async function start() {
  const api = new Api({ base: desk.scene, token: "", mode: "layer", csrf: "" });
  const server = new DeskServer(desk.api);
  const asked = new URLSearchParams(window.location.search).get("reference");
  const [sceneAnswer, answer] = await Promise.all([api.scene(), server.differences(asked)]);
  const images = new Images(api, sceneAnswer);
  const store = new DeskStore(answer);
  images.want([store.current]);
  const scene = await openScene(
    api,
    sceneAnswer,
    () => images.settled(store.current),
    (words) => (root.textContent = words),
  );
  const notices = new Notices();
  store.on("frame", () => images.want(wanted(store)));
  /** @param {string} reference */
  const choose = (reference) => window.location.assign(`?reference=${encodeURIComponent(reference)}`);
  buildDesk(root, { desk, store, scene, images, server, notices, answer, choose });
  images.want(wanted(store));
  window.addEventListener("focus", () => images.retryAll());
  fetchTables({ api, scene, images }, store.current);
  fetchParts();
}

/**
 * The frame looked at, the next difference's, and those beside it in time.
 * @param {DeskStore} store
 */
function wanted(store) {
  const next = store.worst[(store.place + 1) % Math.max(1, store.worst.length)]?.[0] ?? store.current;
  const beside = [store.neighbour(1, store.inTime), store.neighbour(-1, store.inTime)];
  return [...new Set([store.current, next, ...beside])];
}
