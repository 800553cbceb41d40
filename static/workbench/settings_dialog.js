import { openDialog } from "../base/dialogs.js";
import { element } from "../base/dom.js";
import { gettext } from "../base/messages.js";
import { settingGroups } from "./settings.js";

/**
 * @typedef {import("./settings.js").Name} Name
 * @typedef {import("./settings.js").Settings} Settings
 * @typedef {import("./settings.js").Values} Values
 */

/**
 * @template {Name} One
 * @typedef {import("./settings.js").LabelledRow<One>} LabelledRow
 */

/**
 * Made from the table of settings; every change counts at once, so there is nothing to confirm.
 * @param {Settings} settings
 */
export function showSettings(settings) {
  const fields = settingGroups().map(({ title, rows }) =>
    element(
      "fieldset",
      { className: "settings-group" },
      element("legend", {}, title),
      rows.map((row) => field(settings, row)),
    ),
  );
  const reset = element(
    "button",
    { type: "button", onclick: () => resetAll(settings, fields) },
    gettext("Reset to defaults"),
  );
  const close = element("button", { className: "main", autofocus: true }, gettext("Close"));
  const dialog = openDialog({ title: gettext("Settings"), body: fields });
  dialog.querySelector("form")?.append(element("div", { className: "dialog-buttons" }, close, reset));
  dialog.showModal();
}

/** @param {Settings} settings @param {HTMLElement[]} fields a group of settings each */
function resetAll(settings, fields) {
  settingGroups().forEach(({ rows }, index) => {
    rows.forEach(({ name }) => settings.reset(name));
    fields[index].querySelectorAll(".setting").forEach((old, place) => old.replaceWith(field(settings, rows[place])));
  });
}

/**
 * @template {Name} One
 * @param {Settings} settings @param {LabelledRow<One>} row
 */
function field(settings, row) {
  const control = controlOf(settings, row);
  control.dataset.setting = row.name;
  const text = element("span", {}, row.label(), row.hint && element("small", {}, row.hint()));
  return element("label", { className: "setting" }, row.choices || row.range ? [text, control] : [control, text]);
}

/**
 * @template {Name} One
 * @param {Settings} settings @param {LabelledRow<One>} row
 */
function controlOf(settings, { name, choices, range }) {
  if (choices) return menu(settings, name, choices());
  return range ? slider(settings, name, range) : checkBox(settings, name);
}

/**
 * @template {Name} One
 * @param {Settings} settings @param {One} name @param {[Values[One], string][]} choices
 */
function menu(settings, name, choices) {
  const value = settings.get(name);
  const select = element(
    "select",
    {},
    choices.map(([choice, label]) => element("option", { selected: choice === value }, label)),
  );
  select.addEventListener("change", () => settings.set(name, choices[select.selectedIndex][0]));
  return select;
}

/**
 * @template {Name} One
 * @param {Settings} settings @param {One} name @param {{min: number, max: number, step: number}} range
 */
function slider(settings, name, { min, max, step }) {
  const range = { min: String(min), max: String(max), step: String(step) };
  const input = element("input", { type: "range", ...range, value: String(settings.get(name)) });
  input.addEventListener("input", () => settings.set(name, /** @type {Values[One]} */ (input.valueAsNumber)));
  return input;
}

/** @template {Name} One @param {Settings} settings @param {One} name */
function checkBox(settings, name) {
  const input = element("input", { type: "checkbox", checked: settings.get(name) === true });
  input.addEventListener("change", () => settings.set(name, /** @type {Values[One]} */ (input.checked)));
  return input;
}
