import { element } from "../../base/dom.js";
import { gettext } from "../../base/messages.js";
import { toolButton } from "../keys/tool_button.js";

/** @type {[string, () => string][]} ids of the key table, and what the buttons say */
const ABOUT_PERSON = [
  ["rename", () => gettext("Rename")],
  ["split", () => gettext("Split")],
  ["join", () => gettext("Join")],
  ["swap", () => gettext("Swap")],
  ["removeMore", () => gettext("Remove")],
];

/**
 * Buttons under the list of people, for mouse and touch: who is who, clicks on heads, the frame's history.
 * @param {import("../../truth/store.js").Store} store
 * @param {(id: string) => void} perform by the ids of the key table
 * @param {import("../placing/heads.js").Heads} heads
 */
export function panelTools(store, perform, heads) {
  const person = ABOUT_PERSON.map(([id, text]) => toolButton(id, text(), perform));
  const update = () => person.forEach((one) => (one.disabled = store.selection === null));
  store.on("selection", update);
  update();
  const byHead = toolButton("heads", gettext("Heads"), perform);
  byHead.setAttribute("aria-pressed", "false");
  heads.on("change", ({ on }) => byHead.setAttribute("aria-pressed", String(on)));
  const history = toolButton("history", gettext("History"), perform);
  return element("div", { className: "panel-tools" }, person, byHead, history);
}
