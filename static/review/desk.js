import { element, setText } from "../base/dom.js";
import { chord } from "../base/key_press.js";
import { dialogArrives } from "../base/lazy.js";
import { gettext } from "../base/messages.js";
import { CompareIntents } from "../compare/intents.js";
import { markItem } from "../compare/marks.js";
import { mapColours, startOptions } from "../views/display.js";
import { Layout } from "../views/layout.js";
import { Panes } from "../views/panes.js";
import { Pointer } from "../views/pointer.js";
import { CommentList } from "./comments.js";
import { Decisions } from "./decisions.js";
import { DeskPanel } from "./panel.js";
import { strip } from "./strip.js";

/**
 * Builds the desk inside `root`: the panes of the comparison, all differences of the batch in the order of the
 * keys, and what is decided.
 * @typedef {import("./server.js").CommentJSON} CommentJSON
 * @typedef {import("./store.js").DeskStore} DeskStore
 * @typedef {object} Desk what the page says of the assignment
 * @property {string} state
 * @property {string} batch
 * @property {string} worker
 * @property {string|null} why
 * @property {string[]} reasons
 * @property {CommentJSON[]} comments
 * @property {{layer: string, by: string}|null} mended
 * @property {boolean} mine the corrected copy is the reader's
 * @property {boolean} own the work is the reader's
 * @property {string} scene
 * @property {string} api
 * @property {string} home
 * @property {string} desk address of another desk, with 0 for the number
 * @property {string} mend
 * @property {string} appeal address of its decision; empty unless one is open
 * @property {[string, string][]} categories
 * @property {number} least characters of a rejection's reason
 *
 * @typedef {{desk: Desk, store: DeskStore, scene: import("../truth/scene.js").Scene,
 *            images: import("../views/images.js").Images, server: import("./server.js").DeskServer,
 *            notices: import("../base/notices.js").Notices, answer: import("./store.js").Answer,
 *            choose: (reference: string) => void}} Parts
 * @typedef {Record<string, () => unknown>} Actions by the key
 * @param {HTMLElement} root @param {Parts} parts
 */
export function buildDesk(root, parts) {
  const { desk, store, scene, images, notices } = parts;
  const panes = new Panes({ scene, store, images, options: startOptions(), people: () => new Map() });
  panes.addExtra((pane) => {
    const labels = panes.options.labelOpacity > 0;
    const items = store.marks().map((mark) => markItem(pane, mark, mark.key === store.selection, labels));
    return items.filter((item) => item !== null).reverse();
  });
  store.on("marks", () => panes.markPeople());
  const comments = new CommentList(desk.comments, {
    go: (comment) => goTo(comment, store, panes),
    resolve: (comment) => resolve(comment, parts, comments),
    ordinal: (frame) => store.ordinal(frame),
  });
  const decisions = new Decisions({ ...parts, comments, names: { found: desk.worker } });
  const actions = actionsOf(parts, panes, decisions);
  const panel = new DeskPanel(parts, comments.element, (key) => {
    store.select(key);
    panes.zoom(key !== null);
  });
  const stage = element("main", { className: "stage" });
  root.replaceChildren(bar(parts, actions), stage, strip(store), notices.element);
  const layout = new Layout(stage, panes, panel.element, scene.cameras[0].width / scene.cameras[0].height);
  new Pointer(
    panes,
    new CompareIntents({ store, enlarge: (pane) => layout.setLarge(layout.large === pane ? null : pane) }),
  );
  document.onkeydown = (event) => onKey(event, actions);
  document.documentElement.addEventListener("themechange", () => panes.set("mapColours", mapColours()));
}

/** @param {Parts} parts @param {Panes<any, any>} panes @param {Decisions} decisions @returns {Actions} */
function actionsOf({ store, desk }, panes, decisions) {
  /** @param {number} by */
  const difference = (by) => {
    if (store.step(by)) panes.zoom(true);
  };
  const decide = desk.state === "submitted" && !desk.own;
  return {
    n: () => difference(1),
    p: () => difference(-1),
    ArrowRight: () => store.open(store.neighbour(1, store.inTime)),
    ArrowLeft: () => store.open(store.neighbour(-1, store.inTime)),
    Tab: () => {
      store.select(following(store));
      panes.zoom(true);
    },
    Escape: () => {
      store.select(null);
      panes.zoom(false);
    },
    l: () => panes.set("labelOpacity", panes.options.labelOpacity ? 0 : 1),
    ...(decide && {
      a: () => (desk.mine ? decisions.acceptMended() : decisions.accept()),
      ...(desk.mine && { o: () => decisions.accept() }),
      r: () => decisions.giveBack(),
      x: () => decisions.reject(),
      m: () => mend(desk),
    }),
    ...(desk.state === "returned" && !desk.own && { t: () => decisions.takeBack() }),
    ...((decide || (desk.state === "returned" && !desk.own)) && { c: () => decisions.comment() }),
  };
}

/** @param {DeskStore} store */
function following(store) {
  const keys = store.marks().map(({ key }) => key);
  return keys.length ? keys[(keys.indexOf(store.selection ?? 0) + 1) % keys.length] : null;
}

/** @param {KeyboardEvent} event @param {Actions} actions */
function onKey(event, actions) {
  const busy = dialogArrives() || document.querySelector("dialog[open]");
  const typing = event.target instanceof HTMLElement && event.target.matches("select, textarea, input");
  const name = chord(event);
  if (busy || typing || event.repeat || !(name in actions)) return;
  event.preventDefault();
  actions[name]();
}

/** A copy under the reviewer's own name, opened in the workbench. @param {Desk} desk */
function mend({ mend: address }) {
  const meta = document.querySelector("meta[name=csrf-token]");
  const value = meta instanceof HTMLMetaElement ? meta.content : "";
  const form = element("form", { method: "post", action: address });
  form.append(element("input", { type: "hidden", name: "csrfmiddlewaretoken", value }));
  document.body.append(form);
  form.submit();
}

/** @param {CommentJSON} comment @param {DeskStore} store @param {Panes<any, any>} panes */
function goTo({ frame, person, position }, store, panes) {
  if (frame === null) return;
  store.open(frame);
  const mark = store.marks().find(({ truth, found }) => {
    const side = found ?? truth;
    return person === null ? side?.position === position : found?.person === person;
  });
  store.select(mark?.key ?? null);
  panes.zoom(mark !== undefined);
}

/** @param {CommentJSON} comment @param {Parts} parts @param {CommentList} list */
async function resolve(comment, { server, notices }, list) {
  try {
    list.show((await server.resolve(comment.id, !comment.resolved)).comments);
  } catch (error) {
    notices.say(error instanceof Error ? error.message : String(error));
  }
}

/** @param {Parts} parts @param {Actions} actions */
function bar({ desk, store }, actions) {
  const place = element("span", { className: "place", role: "status" });
  const show = () => setText(place, placeWords(store));
  store.on("frame", show);
  store.on("selection", show);
  show();
  /** @param {string} key @param {string} words @param {string} [className] */
  const button = (key, words, className = "") =>
    key in actions
      ? element(
          "button",
          { type: "button", className, "data-key": key, onclick: () => actions[key]() },
          words,
          " ",
          element("kbd", {}, key.toUpperCase()),
        )
      : "";
  return element(
    "header",
    { className: "bar" },
    element("a", { className: "home", href: desk.home, title: desk.worker }, `← ${desk.batch}, ${desk.worker}`),
    store.worst.length ? button("p", gettext("Previous")) : "",
    place,
    store.worst.length ? button("n", gettext("Next difference")) : "",
    element("span", { className: "gap" }),
    "a" in actions ? "" : element("span", { className: "left" }, stateWords(desk)),
    desk.appeal ? element("a", { className: "home", href: desk.appeal }, gettext("Decide the appeal")) : "",
    button("c", gettext("Comment")),
    button("t", gettext("Take back")),
    button("m", gettext(desk.mine ? "Go on correcting" : "Correct it myself")),
    button("o", gettext("Accept the original")),
    button("r", gettext("Return")),
    button("x", gettext("Reject")),
    button("a", gettext(desk.mine ? "Accept the corrected copy" : "Accept"), "main"),
  );
}

/** @param {DeskStore} store */
function placeWords(store) {
  const frame = store.ordinal(store.current);
  if (!store.worst.length) return gettext("Frame {frame} · no differences", { frame });
  if (store.place < 0) return gettext("Frame {frame} · {count} differences", { frame, count: store.worst.length });
  return gettext("Frame {frame} · difference {at} of {count}, worst first", {
    frame,
    at: store.place + 1,
    count: store.worst.length,
  });
}

/** @param {Desk} desk */
function stateWords({ state, own }) {
  if (own) return gettext("This is your own work: somebody else reviews it.");
  /** @type {Record<string, string>} */
  const words = {
    accepted: gettext("Accepted."),
    rejected: gettext("Rejected."),
    returned: gettext("With its worker again."),
    leased: gettext("Still being annotated."),
    expired: gettext("The lease ran out."),
  };
  return words[state] ?? "";
}
