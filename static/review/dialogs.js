import { openDialog } from "../base/dialogs.js";
import { element } from "../base/dom.js";
import { gettext } from "../base/messages.js";

/**
 * What the reviewer writes: a comment, what has to be put right, why work is rejected. Ctrl+Enter sends.
 * @typedef {{text: string, category: string}} Written
 * @typedef {{title: string, body?: string[], label: string, send: string, least?: number,
 *            categories?: [string, string][]}} Question
 * @param {Question} question
 * @returns {Promise<Written|null>} null: Escape
 */
export function write({ title, body = [], label, send, least = 0, categories = [] }) {
  return new Promise((resolve) => {
    const text = element("textarea", { rows: 4, maxLength: 2000, required: least > 0, "aria-label": label });
    const left = element("small", { className: "left" });
    const choice = element(
      "select",
      { "aria-label": gettext("Category") },
      ...categories.map(([value, words]) => element("option", { value }, words)),
    );
    const button = element("button", { type: "submit", className: "main", value: "send" }, send);
    const dialog = openDialog({ title, body: [...body, field(categories, choice), field([1], text, label), left] });
    const count = () => {
      const missing = least - text.value.trim().length;
      left.textContent = missing > 0 ? gettext("{n} more characters", { n: missing }) : "";
      button.disabled = missing > 0;
    };
    text.addEventListener("input", count);
    count();
    dialog.querySelector("form")?.append(element("div", { className: "dialog-buttons" }, button, cancel(dialog)));
    dialog.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && (event.ctrlKey || event.metaKey) && !button.disabled) dialog.close("send");
    });
    dialog.addEventListener("close", () => {
      const { value } = text;
      resolve(dialog.returnValue === "send" ? { text: value.trim(), category: choice.value } : null);
    });
    dialog.showModal();
    text.focus();
  });
}

/** @param {HTMLDialogElement} dialog */
function cancel(dialog) {
  return element("button", { type: "button", onclick: () => dialog.close("") }, gettext("Cancel"));
}

/** @param {unknown[]} wanted nothing for none @param {HTMLElement} control @param {string} [label] */
function field(wanted, control, label = gettext("Category")) {
  if (!wanted.length) return "";
  return element("label", { className: "field" }, element("span", {}, label), control);
}
