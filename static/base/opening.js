import { element } from "./dom.js";
import { problemWords } from "./failure_words.js";
import { gettext } from "./messages.js";

/**
 * @typedef {object} Failing what is said when a page cannot be opened
 * @property {string} title
 * @property {string} home where the way back leads
 * @property {string} [comfort] what is not lost
 * @property {(error: unknown) => string} [reason]
 */

/**
 * Open a page, or show in its place why that failed, and the way back.
 * @param {HTMLElement} root @param {() => Promise<void>} open @param {Failing} failing
 */
export async function opening(root, open, failing) {
  try {
    await open();
    root.dataset.ready = "true";
  } catch (error) {
    console.error(error);
    root.replaceChildren(problem(error, failing));
  }
}

/** @param {unknown} error @param {Failing} failing */
function problem(error, { title, home, comfort, reason = problemWords }) {
  return element(
    "div",
    { className: "start-problem", role: "alert" },
    element("h1", {}, title),
    element("p", {}, reason(error)),
    comfort === undefined ? null : element("p", {}, comfort),
    element(
      "button",
      { type: "button", className: "main", onclick: () => window.location.reload() },
      gettext("Try again"),
    ),
    element("a", { href: home }, gettext("Back")),
  );
}
