import { titleFor } from "./keys.js";

/** Tooltips of buttons say which key does the same. */
export function nameKeys(root) {
  for (const button of root.querySelectorAll("[data-action]")) button.title = titleFor(button.dataset.action);
}
