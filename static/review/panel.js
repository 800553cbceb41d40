import { element } from "../base/dom.js";
import { gettext } from "../base/messages.js";
import { MarksPanel } from "../compare/panel.js";

/**
 * The side panel: beside what the batch is laid, why a person looks at it, who is in the frame, and the comments.
 */
export class DeskPanel {
  /**
   * @param {import("./desk.js").Parts} parts @param {HTMLElement} comments @param {(key: number|null) => void} select
   */
  constructor({ desk, store, answer, choose }, comments, select) {
    const names = { truth: answer.reference ?? desk.worker, found: desk.worker };
    const marks = new MarksPanel(store, names, select);
    this.element = marks.element;
    this.element.classList.add("desk-panel");
    this.element.prepend(beside(answer, choose), whyWords(desk), comments);
  }
}

/** @param {import("./store.js").Answer} answer @param {(reference: string) => void} choose */
function beside({ reference, references }, choose) {
  const options = [
    ...references.map(({ name, about }) => ({ value: name, words: `${about} – ${name}` })),
    { value: "", words: gettext("nothing: the worker's annotations alone") },
  ];
  const select = element(
    "select",
    { "aria-label": gettext("Reference") },
    ...options.map(({ value, words }) => element("option", { value, selected: value === (reference ?? "") }, words)),
  );
  select.addEventListener("change", () => {
    select.blur();
    choose(select.value);
  });
  return element("label", { className: "field beside" }, element("span", {}, gettext("Beside")), select);
}

/** @param {import("./desk.js").Desk} desk */
function whyWords({ why, reasons }) {
  /** @type {Record<string, string>} */
  const words = {
    all: gettext("Everything is reviewed here."),
    newcomer: gettext("The worker is new: everything is reviewed."),
    suspicion: gettext("Chosen because it looks suspicious."),
    chance: gettext("Chosen by chance."),
    unknown: gettext("Chosen because its score could not be told."),
  };
  const text = [words[why ?? ""] ?? "", ...reasons].filter(Boolean).join(" ");
  return element("p", { className: "why", hidden: !text }, text);
}
