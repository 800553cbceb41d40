import { Comments } from "./comments.js";

// Only the page of a batch with comments names this module, so that nobody else loads it.
document.addEventListener("built", (event) => {
  if (!(event instanceof CustomEvent)) return;
  event.detail.panel.element.prepend(new Comments(event.detail).element);
});
