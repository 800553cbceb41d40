import { Api } from "../base/api.js";
import { useCatalog } from "../base/messages.js";
import { Images } from "../views/images.js";

/**
 * What takes longest is asked for first: this module is small, and the scene and the first pictures are on their
 * way while the browser still fetches the others.
 * @returns {Promise<{api: Api, scene: object, first: number, images: Images}>} `scene` as the server answers it;
 *   `first`: the frame to open
 */
async function start() {
  const { api: base, token, mode } = document.body.dataset;
  const csrf = document.querySelector("meta[name=csrf-token]")?.content ?? "";
  const api = new Api({ base, token, mode, csrf });
  const scene = await api.scene();
  const first = firstUnfinished(scene);
  const images = new Images(api, scene);
  images.want([first]);
  return { api, scene, first, images };
}

/** Continue where one was. */
function firstUnfinished({ frames }) {
  return (frames.find(({ done }) => !done) ?? frames[0]).number;
}

const catalog = document.getElementById("catalog");
if (catalog) useCatalog(JSON.parse(catalog.textContent)); // before anything can have to be said

export const started = start();
started.catch(() => {}); // whoever waits for it says why
