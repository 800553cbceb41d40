import { element } from "../base/dom.js";
import { gettext } from "../base/messages.js";
import { PLAIN, RANGE } from "./adjustments.js";

/** Beside the views, so that what it changes is seen at once: which are shown, which is large, how bright. */
export class ViewsMenu {
  constructor(views) {
    this._views = views;
    this._rows = [];
    this.element = element(
      "section",
      { className: "views-menu", hidden: true, "aria-label": gettext("Views") },
      this._build(),
    );
    this._attach();
    for (const name of ["hiddenViews", "largeView", "tones"]) views.settings.watch(name, () => this._update());
  }

  toggle() {
    this.element.hidden = !this.element.hidden;
    if (!this.element.hidden) this.element.querySelector("input").focus();
    else document.activeElement?.blur();
  }

  _build() {
    const { panes } = this._views;
    const cameras = panes.all.filter(({ view }) => view.index !== null);
    return [
      element(
        "table",
        {},
        element(
          "thead",
          {},
          element(
            "tr",
            {},
            headings().map((text) => (text ? element("th", { scope: "col" }, text) : element("td", {}))),
          ),
        ),
        element(
          "tbody",
          {},
          this._row(gettext("All cameras"), cameras, null),
          panes.all.map((pane) => this._row(pane.view.title, [pane], pane)),
        ),
      ),
      element(
        "div",
        { className: "dialog-buttons" },
        this._button(gettext("Show all, alike"), () => this._views.showAll()),
        this._button(gettext("Close"), () => this.toggle()),
      ),
    ];
  }

  /** @param {object|null} pane null: the row that sets all cameras at once */
  _row(title, panes, pane) {
    const check =
      pane &&
      element("input", {
        type: "checkbox",
        "aria-label": gettext("Show {view}", { view: title }),
        onchange: ({ target }) => this._show(pane, target),
      });
    const large =
      pane &&
      element("input", {
        type: "checkbox",
        "aria-label": gettext("{view} large", { view: title }),
        onchange: () => this._views.enlarge(pane),
      });
    const isPicture = panes.some(({ view }) => view.index !== null);
    const sliders = isPicture ? Object.keys(PLAIN).map((name) => this._slider(name, title, panes)) : [];
    const reset =
      isPicture &&
      this._button("↺", () => this._views.setTone(panes, PLAIN), gettext("{view} as it was", { view: title }));
    this._rows.push({ pane, panes, check, large, sliders });
    const cells = [check, title, large, ...(isPicture ? [...sliders, reset] : [null, null, null, null])];
    return element(
      "tr",
      {},
      cells.map((cell) => element("td", {}, cell)),
    );
  }

  _slider(name, title, panes) {
    return element("input", {
      type: "range",
      ...RANGE,
      value: 1,
      "data-tone": name,
      "aria-label": gettext("{what} of {view}", { what: toneWords(name), view: title }),
      oninput: ({ target }) => this._views.setTone(panes, { [name]: target.valueAsNumber }),
    });
  }

  _button(text, onclick, name = null) {
    return element(
      "button",
      { type: "button", className: "quiet", title: name ?? "", "aria-label": name ?? text, onclick },
      text,
    );
  }

  /** The last view stays, whatever was clicked. */
  _show(pane, box) {
    this._views.show(pane, box.checked);
    box.checked = this._views.isShown(pane);
  }

  /** Escape closes it; after a mouse or a finger the keys are for annotating again. */
  _attach() {
    this.element.addEventListener("keydown", (event) => {
      if (event.key !== "Escape") return;
      event.preventDefault();
      event.stopPropagation();
      this.toggle();
    });
    this.element.addEventListener("click", (event) => event.detail > 0 && document.activeElement?.blur());
  }

  _update() {
    const { settings } = this._views;
    for (const { pane, panes, check, large, sliders } of this._rows) {
      if (check) check.checked = this._views.isShown(pane);
      if (large) large.checked = settings.get("largeView") === pane.view.id;
      const tone = this._views.tone(panes[0]);
      for (const slider of sliders) slider.value = tone[slider.dataset.tone];
    }
  }
}

function headings() {
  return [
    gettext("Shown"),
    gettext("View"),
    gettext("Large"),
    gettext("Brightness"),
    gettext("Contrast"),
    gettext("Gamma"),
    "",
  ];
}

function toneWords(name) {
  return { brightness: gettext("Brightness"), contrast: gettext("Contrast"), gamma: gettext("Gamma") }[name];
}
