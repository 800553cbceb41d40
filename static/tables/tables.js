/**
 * The tables in which boxes of the usual person are looked up: fetched one camera after the other, by a worker.
 */

import { gettext } from "../base/messages.js";
import { MODELS } from "../geometry/camera.js";
import { Scene } from "../truth/scene.js";

/**
 * Boxes of cameras are looked up from now on as their tables arrive, and computed until then. Both are the same to
 * the pixel, so nothing has to be painted anew; a table that does not arrive is not missed.
 */
export async function fetchTables({ api, scene, images }, first) {
  await images.settled(first); // pictures come first
  const wanted = scene.wantedTables();
  await eachTable(api, wanted, ({ index }, { boxes }) => boxes && scene.useTable(index, boxes));
}

/**
 * The scene, with cameras of models that this page does not know made of their tables: nothing can be shown without.
 * @param {object} answer the server's scene
 * @param {() => Promise} pictures those that come first
 * @param {(words: string) => void} say how far it is
 */
export async function openScene(api, answer, pictures, say) {
  const wanted = answer.cameras.filter(({ model = "pinhole" }) => !MODELS.includes(model));
  if (!wanted.length) return new Scene(answer);
  await pictures();
  const scene = new Scene(answer, await camerasByTable(api, answer, wanted, say));
  const { OwnSizes } = await import("./own_sizes.js");
  scene.askFor(new OwnSizes(api));
  return scene;
}

/** @returns {Promise<Map<number, {camera: object, boxes: Int16Array}>>} by index */
async function camerasByTable(api, answer, wanted, say) {
  const [{ TableCamera }, { Grid }] = await Promise.all([
    import("../geometry/table_camera.js"),
    import("../geometry/grid.js"),
  ]);
  const grid = new Grid(answer.grid);
  const made = new Map();
  const keep = (camera, { error, ...table }) => {
    if (error) throw new Error(gettext("What {view} sees did not arrive: {error}", { view: camera.name, error }));
    made.set(camera.index, { camera: new TableCamera(camera, grid, table), boxes: table.boxes });
  };
  await eachTable(api, wanted, keep, (camera, loaded, total) => say(loadingWords(camera, loaded, total)));
  return made;
}

function loadingWords({ name }, loaded, total) {
  const megabytes = (bytes) => (bytes / 1e6).toFixed(1);
  if (!loaded) return gettext("Loading what {view} sees…", { view: name });
  return gettext("Loading what {view} sees: {loaded} of {total} MB", {
    view: name,
    loaded: megabytes(loaded),
    total: megabytes(total),
  });
}

/** @param {import("../geometry/camera.js").CameraJSON[]} cameras */
async function eachTable(api, cameras, keep, tell = () => {}) {
  const worker = new Worker(import.meta.resolve("./grid_worker.js"), { type: "module" });
  try {
    for (const camera of cameras) {
      tell(camera, 0, 0);
      const start = performance.now();
      const { width, height, grid } = camera;
      const question = { address: new URL(grid, window.location.href).href, headers: api.headers(), width, height };
      const found = await ask(worker, question, (loaded, total) => tell(camera, loaded, total));
      if (found.decoded) performance.measure("grid file", { start, duration: found.decoded });
      keep(camera, found);
    }
  } finally {
    worker.terminate();
  }
}

/** @returns {Promise<{boxes, feet, index, decoded: number}|{error: string}>} `decoded`: ms */
function ask(worker, question, tell) {
  return new Promise((answer) => {
    worker.onmessage = ({ data }) => (data.loaded ? tell(data.loaded, data.total) : answer(data));
    worker.onerror = () => answer({ error: gettext("the server does not answer") });
    worker.postMessage(question);
  });
}
