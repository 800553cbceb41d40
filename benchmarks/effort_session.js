/** The real workbench with nobody behind it: what the server would say is made up, and nothing is sent. */
import { Activity } from "/static/saving/activity.js";
import { Journal } from "/static/saving/journal.js";
import { Loader } from "/static/saving/loader.js";
import { Saver } from "/static/saving/saver.js";
import { History } from "/static/truth/history.js";
import { withRefill } from "/static/truth/keyframes.js";
import { Scene } from "/static/truth/scene.js";
import { Store } from "/static/truth/store.js";
import { Images } from "/static/views/images.js";
import { Panes } from "/static/views/panes.js";
import { Sheet } from "/static/workbench/sheet/sheet.js";
import { buildWorkbench } from "/static/workbench/workbench.js";

/** @returns the session, its panes as the page builds them (view → pane), and what answers with its sheet, once opened */
export async function openWorkbench(json, proposed) {
  const panes = new Map();
  const add = Panes.prototype.addExtra;
  Panes.prototype.addExtra = function noted(extra) {
    for (const pane of this.all) panes.set(pane.view.index ?? "map", pane);
    add.call(this, extra);
  };
  let opened = null;
  const show = Sheet.prototype.show;
  Sheet.prototype.show = function noted(shown) {
    opened = this;
    show.call(this, shown);
  };
  Element.prototype.setPointerCapture = () => {}; // made-up pointers cannot be captured
  const session = makeSession(new Scene(json), await Journal.open(null), proposed);
  buildWorkbench(document.getElementById("workbench"), session, { mode: "assignment", home: "/" });
  await new Promise((done) => setTimeout(done, 300)); // until the panes know their size
  return { session, panes, sheet: () => opened };
}

function makeSession(scene, journal, proposed) {
  const empty = scene.frames.map(({ number }) => ({
    number,
    revision: 0,
    annotations: [],
    done: false,
    nobody: false,
  }));
  const api = {
    ask: async (_method, path) => (path === "proposals/" ? proposed : null), // nobody snaps here
    frames: async () => ({ frames: empty }),
    blob: () => Promise.reject(new Error("no pictures here")),
  };
  const store = new Store(
    scene.frames.map(({ number }) => number),
    scene.nextPerson,
  );
  const loader = new Loader({ api, scene, store });
  const activity = new Activity();
  const saver = new Saver({ api, store, journal, activity, practice: true });
  const history = new History(store, (patch) => withRefill(store, scene, patch));
  loader.connect(saver, empty);
  return { api, scene, store, history, saver, loader, journal, images: new Images(api, scene), activity };
}
