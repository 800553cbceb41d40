import { ask } from "../base/dialogs.js";
import { element, required } from "../base/dom.js";
import { gettext } from "../base/messages.js";

/**
 * Somebody else (or another tab) changed the same people: ask for each whose version stays.
 * @returns {Promise<Map<number, Side>>}
 * @typedef {"ours"|"theirs"} Side
 * @typedef {import("../truth/scene.js").Scene} Scene
 * @typedef {import("../truth/merge.js").Conflict} Conflict
 * @param {Scene} scene @param {import("../truth/store.js").Store} store
 * @param {import("./edit_record.js").Question} question
 */
export async function askAboutConflicts(scene, store, { frame, conflicts, author, savedAt }) {
  const place = store.numbers.indexOf(frame) + 1;
  const rows = conflicts.map((conflict) => conflictRow(scene, conflict, otherWords(author, savedAt)));
  const question = {
    title: gettext("Frame {place} was changed in two places", { place }),
    body: [
      gettext("Everything else was put together. For these people, which one is right?"),
      gettext("Both stay in the history of the frame."),
      element("div", { className: "conflicts" }, rows),
    ],
    buttons: [{ id: "apply", label: gettext("Use these"), main: true }],
  };
  while ((await ask(question)) !== "apply"); // Escape decides nothing
  return new Map(conflicts.map(({ person }, index) => [person, chosen(rows[index])]));
}

/** @param {HTMLElement} row @returns {Side} */
function chosen(row) {
  return required(row, "input:checked", HTMLInputElement).value === "theirs" ? "theirs" : "ours";
}

/**
 * Who the other is, as far as is known: another tab does not say.
 * @param {string} author @param {string|null} savedAt
 */
function otherWords(author, savedAt) {
  if (!author) return gettext("the other");
  const time = new Date(savedAt ?? 0).toLocaleTimeString([], { hour: "2-digit", minute: "2-digit" });
  return gettext("the other, by {author} at {time}", { author, time });
}

/** @param {Scene} scene @param {Conflict} conflict @param {string} other */
function conflictRow(scene, { person, ours, theirs }, other) {
  /** @type {(value: Side, text: string, one: Conflict["ours"], checked: boolean) => HTMLElement} */
  const choice = (value, text, annotation, checked) =>
    element(
      "label",
      {},
      element("input", { type: "radio", name: `person-${person}`, value, checked }),
      `${text}: ${describe(scene, annotation)}`,
    );
  return element(
    "fieldset",
    {},
    element("legend", {}, gettext("Person {person}", { person })),
    choice("ours", gettext("mine"), ours, true),
    choice("theirs", other, theirs, false),
  );
}

/** @param {Scene} scene @param {Conflict["ours"]} annotation */
function describe(scene, annotation) {
  if (!annotation) return gettext("removed");
  const { x, y } = scene.metres(annotation.position);
  const state = annotation.state === "carried" ? gettext("carried over") : gettext("validated");
  return gettext("at {x} m, {y} m, {state}", { x: x.toFixed(2), y: y.toFixed(2), state });
}
