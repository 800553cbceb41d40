import { ApiError, NetworkError } from "../base/api.js";
import { required } from "../base/dom.js";
import { failureWords } from "../base/failure_words.js";
import { fetchParts } from "../base/lazy.js";
import { gettext } from "../base/messages.js";
import { opening } from "../base/opening.js";
import { openSession } from "../saving/session.js";
import { fetchTables } from "../tables/tables.js";
import { started } from "./start.js";
import { buildWorkbench } from "./workbench.js";

const { mode = "", home = "" } = document.body.dataset;
const root = required(document, "#workbench", HTMLElement);

/** @param {unknown} error */
function reason(error) {
  if (!(error instanceof NetworkError || error instanceof ApiError))
    return error instanceof Error ? error.message : String(error);
  return gettext("It could not be loaded: {reason}.", { reason: failureWords(error) });
}

await opening(root, start, {
  title: gettext("The workbench could not start"),
  home,
  comfort: gettext("Nothing is lost: edits are kept on this computer until the server has them."),
  reason,
});

async function start() {
  const waiting = root.querySelector(".starting");
  const session = await openSession(await started, (words) => {
    if (waiting) waiting.textContent = words;
  });
  await buildWorkbench(root, session, { mode, home });
  fetchTables(session, session.store.current);
  document.addEventListener("keydown", fetchParts, { once: true });
  document.addEventListener("pointerdown", fetchParts, { once: true });
}
