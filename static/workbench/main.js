import { ApiError, NetworkError } from "../base/api.js";
import { element } from "../base/dom.js";
import { failureWords } from "../base/failure_words.js";
import { fetchParts } from "../base/lazy.js";
import { gettext } from "../base/messages.js";
import { openSession } from "../saving/session.js";
import { fetchTables } from "../tables/tables.js";
import { started } from "./start.js";
import { buildWorkbench } from "./workbench.js";

const { mode = "", home = "" } = document.body.dataset;
const root = document.getElementById("workbench");
if (!root) throw new Error("this page has no place for the workbench");

/** @param {unknown} error */
function reason(error) {
  if (!(error instanceof NetworkError || error instanceof ApiError))
    return error instanceof Error ? error.message : String(error);
  return gettext("It could not be loaded: {reason}.", { reason: failureWords(error) });
}

try {
  const waiting = root.querySelector(".starting");
  const session = await openSession(await started, (words) => {
    if (waiting) waiting.textContent = words;
  });
  await buildWorkbench(root, session, { mode, home });
  root.dataset.ready = "true";
  fetchTables(session, session.store.current);
  document.addEventListener("keydown", fetchParts, { once: true });
  document.addEventListener("pointerdown", fetchParts, { once: true });
} catch (error) {
  console.error(error);
  root.replaceChildren(
    element(
      "div",
      { className: "start-problem", role: "alert" },
      element("h1", {}, gettext("The workbench could not start")),
      element("p", {}, reason(error)),
      element("p", {}, gettext("Nothing is lost: edits are kept on this computer until the server has them.")),
      element(
        "button",
        { type: "button", className: "main", onclick: () => window.location.reload() },
        gettext("Try again"),
      ),
      element("a", { href: home }, gettext("Back")),
    ),
  );
}
