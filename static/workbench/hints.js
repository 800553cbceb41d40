import { element } from "../base/dom.js";
import { gettext } from "../base/messages.js";
import { carriedOf } from "../truth/annotation.js";
import { keyFor } from "./keys/keys.js";

/**
 * @typedef {"moving"|"yellow"|"zooming"} HintId
 * @typedef {object} Parts
 * @property {import("../truth/store.js").Store} store
 * @property {import("./settings.js").Settings} settings
 */

const SHOWN = 20_000; // ms

/** One short hint under the list of people when it is needed for the first time; none comes twice. */
export class Hints {
  /** @param {Parts} parts */
  constructor({ store, settings }) {
    this._store = store;
    this._settings = settings;
    /** @type {ReturnType<typeof setTimeout>|undefined} */
    this._timer = undefined;
    this._text = element("p", {});
    const close = element(
      "button",
      { type: "button", className: "quiet", "aria-label": gettext("Close this hint"), onclick: () => this._hide() },
      "✕",
    );
    this._box = element("div", { className: "hint", hidden: true }, this._text, close);
    this.element = element("div", { role: "status" }, this._box);
    store.on("selection", ({ after }) => after !== null && this._give("moving"));
    store.on("frame", () => this._lookForYellow());
    store.on("change", () => this._lookForYellow());
    settings.on("change", ({ name, value }) => name === "hints" && this._switch(value));
    if (store.selection !== null) this._give("moving"); // what was done while this was fetched
    this._lookForYellow();
  }

  zoomed() {
    this._give("zooming");
  }

  _lookForYellow() {
    if (carriedOf(this._store.people()).length) this._give("yellow");
  }

  /** @param {HintId} id */
  _give(id) {
    const shown = this._settings.get("hintsShown");
    if (!this._settings.get("hints") || shown.includes(id)) return;
    this._settings.set("hintsShown", [...shown, id]);
    this._text.textContent = words(id);
    this._box.hidden = false;
    clearTimeout(this._timer);
    this._timer = setTimeout(() => this._hide(), SHOWN);
  }

  _hide() {
    this._box.hidden = true;
  }

  /**
   * Whoever switches them on again wants to read them again.
   * @param {boolean} on
   */
  _switch(on) {
    if (on) this._settings.reset("hintsShown");
    else this._hide();
  }
}

/** @param {HintId} id */
function words(id) {
  const texts = {
    moving: () =>
      gettext(
        "Arrow keys move the person by one step, {far} by ten. {zoom} shows the person large in all views, {help} all keys.",
        {
          far: keyFor("leftFar"),
          zoom: keyFor("zoom"),
          help: keyFor("help"),
        },
      ),
    yellow: () =>
      gettext(
        "Yellow people were carried over and wait to be looked at: {next} goes to the next one, {validate} says that it stands right.",
        {
          next: keyFor("nextCarried"),
          validate: keyFor("validate"),
        },
      ),
    zooming: () =>
      gettext(
        "Drag moves the zoomed picture, a double click makes the view large, {views} sets brightness and contrast.",
        { views: keyFor("views") },
      ),
  };
  return texts[id]();
}
