/**
 * The tables in which boxes of the usual person are looked up: fetched one camera after the other, by a worker.
 * @typedef {import("../base/answers.js").SceneAnswer} SceneAnswer
 * @typedef {import("../base/api.js").Api} Api
 * @typedef {import("../geometry/camera.js").CameraJSON} CameraJSON
 * @typedef {import("../geometry/table_camera.js").TableCamera} TableCamera
 * @typedef {import("../views/images.js").Images} Images
 * @typedef {import("./grid_worker.js").Answer} Answer
 * @typedef {Map<number, {camera: TableCamera, boxes: Int16Array}>} ByTable cameras of unknown models, by index
 */

import { gettext } from "../base/messages.js";
import { MODELS } from "../geometry/camera.js";
import { Scene } from "../truth/scene.js";

/**
 * Boxes of cameras are looked up from now on as their tables arrive, and computed until then. Both are the same to
 * the pixel, so nothing has to be painted anew; a table that does not arrive is not missed.
 * @param {{api: Api, scene: Scene, images: Images}} parts @param {number} first frame whose pictures come first
 */
export async function fetchTables({ api, scene, images }, first) {
  await images.settled(first); // pictures come first
  const wanted = scene.wantedTables();
  await eachTable(api, wanted, ({ index }, found) => {
    if (!("error" in found)) scene.useTable(index, found.boxes);
  });
}

/**
 * The scene, with cameras of models that this page does not know made of their tables: nothing can be shown without.
 * @param {Api} api @param {SceneAnswer} answer
 * @param {() => Promise<unknown>} pictures those that come first
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

/**
 * @param {Api} api @param {SceneAnswer} answer @param {CameraJSON[]} wanted @param {(words: string) => void} say
 * @returns {Promise<ByTable>}
 */
async function camerasByTable(api, answer, wanted, say) {
  const [{ TableCamera }, { Grid }] = await Promise.all([
    import("../geometry/table_camera.js"),
    import("../geometry/grid.js"),
  ]);
  const grid = new Grid(answer.grid);
  /** @type {ByTable} */
  const made = new Map();
  /** @param {CameraJSON} camera @param {Answer} found */
  const keep = (camera, found) => {
    /** @param {string} error */
    const missing = (error) =>
      new Error(gettext("What {view} sees did not arrive: {error}", { view: camera.name, error }));
    if ("error" in found) throw missing(found.error);
    const { boxes, feet, index } = found;
    if (!feet || !index) throw missing("feet");
    made.set(camera.index, { camera: new TableCamera(camera, grid, { boxes, feet, index }), boxes });
  };
  await eachTable(api, wanted, keep, (camera, loaded, total) => say(loadingWords(camera, loaded, total)));
  return made;
}

/** @param {CameraJSON} camera @param {number} loaded @param {number} total bytes */
function loadingWords({ name }, loaded, total) {
  /** @param {number} bytes */
  const megabytes = (bytes) => (bytes / 1e6).toFixed(1);
  if (!loaded) return gettext("Loading what {view} sees…", { view: name });
  return gettext("Loading what {view} sees: {loaded} of {total} MB", {
    view: name,
    loaded: megabytes(loaded),
    total: megabytes(total),
  });
}

/**
 * @param {Api} api @param {CameraJSON[]} cameras @param {(camera: CameraJSON, found: Answer) => void} keep
 * @param {(camera: CameraJSON, loaded: number, total: number) => void} [tell]
 */
async function eachTable(api, cameras, keep, tell = () => {}) {
  const worker = new Worker(import.meta.resolve("./grid_worker.js"), { type: "module" });
  try {
    for (const camera of cameras) {
      tell(camera, 0, 0);
      const start = performance.now();
      const { width, height, grid } = camera;
      const question = { address: new URL(grid, window.location.href).href, headers: api.headers(), width, height };
      const found = await ask(worker, question, (loaded, total) => tell(camera, loaded, total));
      if ("decoded" in found) performance.measure("grid file", { start, duration: found.decoded });
      keep(camera, found);
    }
  } finally {
    worker.terminate();
  }
}

/**
 * @param {Worker} worker @param {import("./grid_worker.js").Question} question
 * @param {(loaded: number, total: number) => void} tell
 * @returns {Promise<Answer>}
 */
function ask(worker, question, tell) {
  return new Promise((answer) => {
    worker.onmessage = ({ data }) => (data.loaded ? tell(data.loaded, data.total) : answer(data));
    worker.onerror = () => answer({ error: gettext("the server does not answer") });
    worker.postMessage(question);
  });
}
