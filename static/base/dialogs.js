import { element } from "./dom.js";

/**
 * Ask and wait. `buttons` are [{id, label, main?}]; Escape answers `null`.
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
    dialog.querySelector("form").append(element("div", { className: "dialog-buttons" }, row));
    dialog.addEventListener("close", () => resolve(dialog.returnValue || null));
    dialog.showModal();
    (row.find((button) => button.classList.contains("main") && !button.disabled) ?? row[0])?.focus();
    dialog.scrollTop = 0; // a long one is read from its beginning, though the button with the focus is at its end
  });
}

/** A dialog with nothing to decide; closes itself away. Call `showModal` on it. */
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
