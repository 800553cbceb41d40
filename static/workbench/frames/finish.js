import { ApiError } from "../../base/api.js";
import { ask } from "../../base/dialogs.js";
import { element, required } from "../../base/dom.js";
import { failureWords } from "../../base/failure_words.js";
import { gettext, ngettext } from "../../base/messages.js";
import { carriedOf } from "../../truth/annotation.js";

/**
 * @typedef {import("../../truth/store.js").Store} Store
 * @typedef {{api: import("../../base/api.js").Api, navigation: import("./navigation.js").Navigation,
 *            notices: import("../../base/notices.js").Notices, home: string}} Handing what handing in needs
 * @typedef {{number: number, place: number, people: number, carried: number, done: boolean}} Row of a frame
 */

/**
 * What there is to say about every frame of a batch before it is handed in.
 * @param {Store} store
 */
export function summary(store) {
  return store.numbers.map((number, index) => {
    const { people, done } = store.frame(number);
    return { number, place: index + 1, people: people.size, carried: carriedOf(people).length, done };
  });
}

/**
 * The summary after the last frame; submits, or jumps to a frame.
 * @param {Handing & {store: Store, saver: import("../../saving/saver.js").Saver}} parts
 */
export async function finishAssignment({ store, saver, api, navigation, notices, home }) {
  const saved = await saver.flush();
  const rows = summary(store);
  const unfinished = rows.filter(({ done }) => !done);
  const waiting = element(
    "p",
    { role: "status", hidden: saved },
    saved ? "" : gettext("Some edits are not saved yet; wait until “All saved” is shown."),
  );
  const answered = ask({
    title: unfinished.length
      ? ngettext("{n} frame is not finished yet", "{n} frames are not finished yet", unfinished.length)
      : gettext("All {n} frames are done", { n: rows.length }),
    body: [table(rows), waiting],
    buttons: [
      { id: "submit", label: gettext("Submit"), main: true, disabled: unfinished.length > 0 || !saved },
      ...(unfinished.length ? [{ id: "first", label: gettext("Go to the first unfinished frame") }] : []),
      { id: "stay", label: gettext("Back to annotating") },
    ],
  });
  const stop = saver.on("status", () => {
    if (saver.unsaved) return;
    waiting.hidden = true;
    const dialog = waiting.closest("dialog");
    if (dialog) required(dialog, '[data-answer="submit"]', HTMLButtonElement).disabled = unfinished.length > 0;
  });
  const answer = await answered.finally(stop);
  if (answer === "first") return navigation.open(unfinished[0].number);
  if (answer?.startsWith("frame ")) return navigation.open(Number(answer.slice(6)));
  if (answer === "submit") return submit({ api, navigation, notices, home });
}

/** @param {Handing} parts */
async function submit({ api, navigation, notices, home }) {
  try {
    await api.submit();
    window.location.assign(home);
  } catch (error) {
    const frames = error instanceof ApiError && error.code === "unfinished" ? unfinishedIn(error) : [];
    notices.say(gettext("Not submitted: {reason}", { reason: failureWords(error) }));
    if (frames.length) return navigation.open(frames[0]);
  }
}

/** @param {ApiError} error */
function unfinishedIn({ details }) {
  return (details && !Array.isArray(details) && details.frames) || [];
}

/** @param {Row[]} rows */
function table(rows) {
  const head = [gettext("Frame"), gettext("People"), gettext("State"), ""];
  return element(
    "table",
    { className: "summary" },
    element(
      "thead",
      {},
      element(
        "tr",
        {},
        head.map((text) => element("th", { scope: "col" }, text)),
      ),
    ),
    element("tbody", {}, rows.map(tableRow)),
  );
}

/** @param {Row} row */
function tableRow({ number, place, people, carried, done }) {
  const state = done
    ? gettext("done")
    : carried
      ? ngettext("{n} yellow", "{n} yellow", carried)
      : gettext("not finished");
  /** @param {Event} event */
  const go = ({ target }) => target instanceof Element && target.closest("dialog")?.close(`frame ${number}`);
  return element(
    "tr",
    { className: done ? "done" : "open" },
    element("td", {}, String(place)),
    element("td", {}, String(people)),
    element("td", {}, state),
    element("td", {}, element("button", { type: "button", className: "quiet", onclick: go }, gettext("Open"))),
  );
}
