import { element } from "../base/dom.js";
import { gettext } from "../base/messages.js";
import { PLAIN, RANGE } from "./adjustments.js";

/** @type {(keyof import("./adjustments.js").Tone)[]} */
const TONES = ["brightness", "contrast", "gamma"];

/**
 * Beside the views, so that what it changes is seen at once: which are shown, which is large, how bright.
 * @typedef {import("./adjustments.js").Tone} Tone
 * @typedef {import("./pane.js").Pane} Pane
 * @typedef {{name: keyof Tone, input: HTMLInputElement}} Slider
 * @typedef {object} Row
 * @property {Pane|null} pane null: the row that sets all cameras at once
 * @property {Pane[]} panes
 * @property {HTMLInputElement|null} check
 * @property {HTMLInputElement|null} large
 * @property {Slider[]} sliders
 */
export class ViewsMenu {
  /** @param {import("./views.js").Views} views */
  constructor(views) {
    this._views = views;
    /** @type {Row[]} */
    this._rows = [];
    this.element = element(
      "section",
      { className: "views-menu", hidden: true, "aria-label": gettext("Views") },
      this._build(),
    );
    this._attach();
    views.settings.watch("hiddenViews", () => this._update());
    views.settings.watch("largeView", () => this._update());
    views.settings.watch("tones", () => this._update());
  }

  toggle() {
    this.element.hidden = !this.element.hidden;
    if (!this.element.hidden) this.element.querySelector("input")?.focus();
    else letGo();
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
        this._button(gettext("Show all, same size"), () => this._views.showAll()),
        this._button(gettext("Close"), () => this.toggle()),
      ),
    ];
  }

  /** @param {string} title @param {Pane[]} panes @param {Pane|null} pane null: the row that sets all cameras at once */
  _row(title, panes, pane) {
    /** @type {HTMLInputElement|null} */
    const check =
      pane &&
      element("input", {
        type: "checkbox",
        "aria-label": gettext("Show {view}", { view: title }),
        onchange: () => check && this._show(pane, check),
      });
    const large =
      pane &&
      element("input", {
        type: "checkbox",
        "aria-label": gettext("{view} large", { view: title }),
        onchange: () => this._views.enlarge(pane),
      });
    const isPicture = panes.some(({ view }) => view.index !== null);
    const sliders = isPicture ? TONES.map((name) => this._slider(name, title, panes)) : [];
    const reset = isPicture
      ? this._button("↺", () => this._views.setTone(panes, PLAIN), gettext("{view} as it was", { view: title }))
      : null;
    this._rows.push({ pane, panes, check, large, sliders });
    /** @type {(Node|string|null)[]} */
    const cells = [
      check,
      title,
      large,
      ...(isPicture ? [...sliders.map(({ input }) => input), reset] : [null, null, null, null]),
    ];
    return element(
      "tr",
      {},
      cells.map((cell) => element("td", {}, cell)),
    );
  }

  /** @param {keyof Tone} name @param {string} title @param {Pane[]} panes @returns {Slider} */
  _slider(name, title, panes) {
    const input = element("input", {
      type: "range",
      min: String(RANGE.min),
      max: String(RANGE.max),
      step: String(RANGE.step),
      value: "1",
      "data-tone": name,
      "aria-label": gettext("{what} of {view}", { what: toneWords(name), view: title }),
      oninput: () => this._views.setTone(panes, { [name]: input.valueAsNumber }),
    });
    return { name, input };
  }

  /** @param {string} text @param {() => void} onclick @param {string|null} [name] */
  _button(text, onclick, name = null) {
    return element(
      "button",
      { type: "button", className: "quiet", title: name ?? "", "aria-label": name ?? text, onclick },
      text,
    );
  }

  /**
   * The last view stays, whatever was clicked.
   * @param {Pane} pane @param {HTMLInputElement} box
   */
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
    this.element.addEventListener("click", (event) => event.detail > 0 && letGo());
  }

  _update() {
    const { settings } = this._views;
    for (const { pane, panes, check, large, sliders } of this._rows) {
      if (check && pane) check.checked = this._views.isShown(pane);
      if (large && pane) large.checked = settings.get("largeView") === pane.view.id;
      const tone = this._views.tone(panes[0]);
      for (const { name, input } of sliders) input.value = String(tone[name]);
    }
  }
}

/** The keys are the page's again. */
function letGo() {
  if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
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

/** @param {keyof Tone} name */
function toneWords(name) {
  return { brightness: gettext("Brightness"), contrast: gettext("Contrast"), gamma: gettext("Gamma") }[name];
}
