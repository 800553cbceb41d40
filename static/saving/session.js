import { openScene } from "../tables/tables.js";
import { History } from "../truth/history.js";
import { withRefill } from "../truth/keyframes.js";
import { Store } from "../truth/store.js";
import { Activity } from "./activity.js";
import { Journal } from "./journal.js";
import { Loader } from "./loader.js";
import { Saver } from "./saver.js";

/**
 * Everything behind the page: what is annotated, how it is kept, and the pictures. Knows no page.
 * @typedef {{api: import("../base/api.js").Api, scene: import("../truth/scene.js").Scene, store: Store, history: History, saver: Saver, loader: Loader,
 *            journal: Journal, images: import("../views/images.js").Images, activity: Activity}} Session
 */

/**
 * @param {import("../workbench/start.js").Started} started what start.js has asked for already
 * @param {(words: string) => void} say what takes long
 * @returns {Promise<Session>}
 */
export async function openSession({ api, scene: answer, first, images }, say) {
  const scene = await openScene(api, answer, () => images.settled(first), say);
  const store = new Store(
    scene.frames.map(({ number }) => number),
    scene.nextPerson,
  );
  const loader = new Loader({ api, scene, store });
  const [states, journal] = await Promise.all([loader.start(first), Journal.open(...layerNames(scene))]);
  const activity = new Activity();
  const saver = new Saver({ api, store, journal, activity, practice: scene.mode === "tutorial" });
  const history = new History(store, (patch) => withRefill(store, scene, patch));
  loader.connect(saver, states);
  if (!scene.editable) saver.makeReadOnly(scene.readOnlyReason);
  saver.on("renumber", ({ from, to, frames }) => history.renumber(from, to, frames));
  journal.shareNumbers(store);
  await recover({ scene, journal, saver, loader, history, store });
  store.open(first);
  return { api, scene, store, history, saver, loader, journal, images, activity };
}

/**
 * Under which name edits are kept, and under which earlier versions kept them; the tutorial keeps none.
 * Numbers of layers begin anew in every database, so the server gives a key that no other layer has.
 * @param {import("../truth/scene.js").Scene} scene @returns {[layer: string|null, formerly?: string]}
 */
function layerNames({ mode, layer }) {
  if (mode === "tutorial") return [null];
  // Parts of a long layer know nothing of each other's frames.
  const part = layer.first == null ? "" : ` from ${layer.first}`;
  return [`${mode} ${layer.key}${part}`, `${mode} ${layer.id}${part}`];
}

/**
 * Edits the server never acknowledged, and the undo steps, as they were before a reload.
 * @param {Pick<Session, "scene"|"journal"|"saver"|"loader"|"history"|"store">} session
 */
async function recover({ scene, journal, saver, loader, history, store }) {
  for (const record of await journal.recover()) {
    if (!store.frame(record.frame)) continue; // it stays where it is: the frame may come back
    await loader.load(record.frame, false);
    if (!isOfThisLayer(record, scene.layer, saver.revision(record.frame))) continue;
    journal.takeOver(record);
    saver.adopt(record);
  }
  const stored = await journal.takeHistory();
  const keep = () => journal.writeHistory(() => history.dump());
  if (stored) {
    history.restore(stored);
    keep(); // under this tab's name from now on
  }
  history.on("change", keep);
}

/**
 * A layer is older than its edits, and its frames have at least the revision that the edits started from.
 * @param {import("./journal.js").Recovered} record @param {import("../base/answers.js").LayerPart} layer @param {number} revision
 */
function isOfThisLayer({ formerly, at, base }, layer, revision) {
  return !formerly || (at >= Date.parse(layer.created_at ?? "") && (base.revision ?? 0) <= revision);
}
