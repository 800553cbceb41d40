import { openDialog } from "../base/dialogs.js";
import { element } from "../base/dom.js";
import { gettext } from "../base/messages.js";
import { settingGroups } from "./settings.js";

/** Made from the table of settings; every change counts at once, so there is nothing to confirm. */
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
    gettext("As it was at first"),
  );
  const close = element("button", { className: "main", autofocus: true }, gettext("Close"));
  const dialog = openDialog({ title: gettext("Settings"), body: fields });
  dialog.querySelector("form").append(element("div", { className: "dialog-buttons" }, close, reset));
  dialog.showModal();
}

function resetAll(settings, fields) {
  settingGroups().forEach(({ rows }, index) => {
    rows.forEach(({ name }) => settings.reset(name));
    fields[index].querySelectorAll(".setting").forEach((old, place) => old.replaceWith(field(settings, rows[place])));
  });
}

function field(settings, row) {
  const control = controlOf(settings, row);
  control.dataset.setting = row.name;
  const text = element("span", {}, row.label(), row.hint && element("small", {}, row.hint()));
  return element("label", { className: "setting" }, row.choices || row.range ? [text, control] : [control, text]);
}

function controlOf(settings, { name, choices, range }) {
  const value = settings.get(name);
  if (choices) {
    const options = choices();
    return element(
      "select",
      { onchange: ({ target }) => settings.set(name, options[target.selectedIndex][0]) },
      options.map(([choice, label]) => element("option", { selected: choice === value }, label)),
    );
  }
  if (range) {
    return element("input", {
      type: "range",
      ...range,
      value,
      oninput: ({ target }) => settings.set(name, target.valueAsNumber),
    });
  }
  return element("input", {
    type: "checkbox",
    checked: value,
    onchange: ({ target }) => settings.set(name, target.checked),
  });
}
