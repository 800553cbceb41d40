import { element, required } from "./dom.js";

/**
 * @typedef {import("./dom.js").Child} Child
 * @typedef {{title: string, body: Child|Child[], wide?: boolean}} Content texts of the body become paragraphs
 * @typedef {{id: string, label: string, main?: boolean, disabled?: boolean}} Answer a button
 */

/**
 * Ask and wait; Escape answers `null`.
 * @param {Content & {buttons: Answer[]}} question
 * @returns {Promise<string|null>}
 */
export function ask({ title, body, buttons, wide = false }) {
  return new Promise((resolve) => {
    const dialog = openDialog({ title, body, wide });
    const row = buttons.map(({ id, label, main, disabled }) =>
      element(
        "button",
        {
          type: "button",
          className: main ? "main" : "",
          autofocus: Boolean(main),
          disabled,
          "data-answer": id,
          onclick: () => dialog.close(id),
        },
        label,
      ),
    );
    required(dialog, "form", HTMLFormElement).append(element("div", { className: "dialog-buttons" }, row));
    dialog.addEventListener("close", () => resolve(dialog.returnValue || null));
    dialog.showModal();
    (row.find((button) => button.classList.contains("main") && !button.disabled) ?? row[0])?.focus();
    dialog.scrollTop = 0; // a long one is read from its beginning, though the button with the focus is at its end
  });
}

/**
 * A dialog with nothing to decide; closes itself away. Call `showModal` on it.
 * @param {Content} content
 */
export function openDialog({ title, body, wide = false }) {
  const heading = element("h2", { id: "dialog-title" }, title);
  const content = [body].flat().map((part) => (typeof part === "string" ? element("p", {}, part) : part));
  const dialog = element(
    "dialog",
    { className: wide ? "wide" : "", "aria-labelledby": "dialog-title" },
    element("form", { method: "dialog" }, heading, element("div", { className: "dialog-body" }, content)),
  );
  dialog.addEventListener("close", () => dialog.remove());
  document.body.append(dialog);
  return dialog;
}
