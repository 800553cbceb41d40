import { ask } from "../../base/dialogs.js";
import { element } from "../../base/dom.js";
import { gettext } from "../../base/messages.js";
import { KeySheet } from "./key_sheet.js";

/**
 * The key sheet, made from the key table; keys are changed in it.
 * @param {import("../settings.js").Settings} settings
 */
export function showHelp(settings) {
  const keys = new KeySheet(settings);
  const mouse = element(
    "section",
    {},
    element("h3", {}, gettext("Mouse")),
    element(
      "dl",
      {},
      mouseRows().flatMap(([what, label]) => row([element("kbd", {}, what)], label)),
    ),
  );
  return ask({
    title: gettext("Keys and mouse"),
    wide: true,
    body: [keys.message, element("div", { className: "key-sheet" }, mouse, keys.element), keys.reset],
    buttons: [{ id: "close", label: gettext("Close"), main: true }],
  });
}

/** @param {HTMLElement[]} keys @param {string} label */
function row(keys, label) {
  return [element("dt", {}, keys), element("dd", {}, label)];
}

/** @returns {[what: string, label: string][]} */
function mouseRows() {
  return [
    [gettext("Click on feet"), gettext("a new person there, in all views at once")],
    [gettext("Click on a box or a foot point"), gettext("select that person; again: the one behind")],
    [gettext("Shift + click"), gettext("a new person, also inside somebody's box")],
    [gettext("Right click"), gettext("move the selected person here")],
    [
      gettext("Alt or Ctrl + click"),
      gettext("the selected person's feet in one more view: the best place for all clicked views"),
    ],
    [gettext("Drag a foot, a box or a dot"), gettext("move that person; Escape leaves them where they were")],
    [gettext("Drag the top of the selected box"), gettext("the person's height")],
    [gettext("Wheel"), gettext("zoom this view")],
    [gettext("Drag"), gettext("move the zoomed picture; with the middle button also over a person")],
    [gettext("Double click"), gettext("this view large with the others around it, and back")],
    [
      gettext("Touch"),
      gettext("tap: as a click; long press: move the selected person here; one finger moves the picture, two zoom it"),
    ],
  ];
}
