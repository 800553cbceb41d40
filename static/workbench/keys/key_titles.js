import { titleFor } from "./keys.js";

/**
 * Tooltips of buttons say which key does the same.
 * @param {ParentNode} root
 */
export function nameKeys(root) {
  /** @type {NodeListOf<HTMLElement>} */
  const buttons = root.querySelectorAll("[data-action]");
  for (const button of buttons) button.title = titleFor(button.dataset.action ?? "");
}
