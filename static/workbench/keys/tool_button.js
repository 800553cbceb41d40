import { element } from "../../base/dom.js";
import { titleFor } from "./keys.js";

/**
 * A button of a panel that does what a key does.
 * @param {string} id of the key table @param {string} text @param {(id: string) => void} perform
 */
export function toolButton(id, text, perform) {
  /** @type {HTMLButtonElement} */
  const button = element(
    "button",
    {
      type: "button",
      className: "quiet",
      "data-action": id,
      title: titleFor(id),
      onclick: (event) => {
        if (event.detail > 0) button.blur(); // Space would press it again
        perform(id);
      },
    },
    text,
  );
  return button;
}
