import { element } from "../../base/dom.js";
import { gettext } from "../../base/messages.js";
import { titleFor } from "../keys/keys.js";

const ABOUT_PERSON = [
  ["rename", () => gettext("Rename")],
  ["split", () => gettext("Split")],
  ["join", () => gettext("Join")],
  ["swap", () => gettext("Swap")],
  ["removeMore", () => gettext("Remove")],
];

/** Buttons under the list of people, for mouse and touch: who is who, clicks on heads, the frame's history. */
export function panelTools(store, perform, heads) {
  const button = (id, text) =>
    element(
      "button",
      {
        type: "button",
        className: "quiet",
        "data-action": id,
        title: titleFor(id),
        onclick: (event) => {
          if (event.detail > 0) event.currentTarget.blur(); // Space would press it again
          perform(id);
        },
      },
      text,
    );
  const person = ABOUT_PERSON.map(([id, text]) => button(id, text()));
  const update = () => person.forEach((one) => (one.disabled = store.selection === null));
  store.on("selection", update);
  update();
  const byHead = button("heads", gettext("Heads"));
  byHead.setAttribute("aria-pressed", "false");
  heads.on("change", ({ on }) => byHead.setAttribute("aria-pressed", String(on)));
  return element("div", { className: "panel-tools" }, person, byHead, button("history", gettext("History")));
}
