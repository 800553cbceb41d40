import { Api } from "../base/api.js";
import { useCatalog } from "../base/messages.js";
import { Images } from "../views/images.js";

/**
 * @typedef {import("../base/answers.js").SceneAnswer} Answer
 * @typedef {{api: Api, scene: Answer, first: number, images: Images}} Started `first`: the frame to open
 */

/**
 * What takes longest is asked for first: this module is small, and the scene and the first pictures are on their
 * way while the browser still fetches the others.
 * @returns {Promise<Started>}
 */
async function start() {
  const { api: base = "", token = "", mode = "" } = document.body.dataset;
  /** @type {HTMLMetaElement|null} */
  const meta = document.querySelector("meta[name=csrf-token]");
  const api = new Api({ base, token, mode, csrf: meta?.content ?? "" });
  const scene = await api.scene();
  const first = firstUnfinished(scene);
  const images = new Images(api, scene);
  images.want([first]);
  return { api, scene, first, images };
}

/**
 * Continue where one was.
 * @param {Answer} scene
 */
function firstUnfinished({ frames }) {
  return (frames.find(({ done }) => !done) ?? frames[0]).number;
}

const catalog = document.getElementById("catalog");
if (catalog) useCatalog(JSON.parse(catalog.textContent)); // before anything can have to be said

export const started = start();
started.catch(() => {}); // whoever waits for it says why
