import { element, setText } from "./dom.js";
import { gettext } from "./messages.js";

const SETTLED = 600; // ms without an edit before the server is asked

/** Steps in order; the server judges each against the truth it keeps to itself. */
function steps() {
  return [
    {
      id: "place",
      title: gettext("Mark somebody who has no box"),
      text: gettext("One person in this frame has no box. Click on the ground between their feet, in the view where you see them best. The box appears in every view at once."),
      hint: gettext("Is it a little off? The arrow keys move it by 2.5 cm."),
    },
    {
      id: "correct",
      title: gettext("Correct a yellow box"),
      text: gettext("Yellow, dashed boxes were carried over and may be wrong. One stands beside its person: select it (click, or Tab) and move it with the arrow keys until it fits in all views. Z zooms every view to it."),
      hint: gettext("A yellow box that already fits needs no moving: press E to validate it."),
    },
    {
      id: "remove",
      title: gettext("Remove a box with nobody in it"),
      text: gettext("One box has nobody in it. Look at it in several views, select it, and press Backspace."),
      hint: gettext("Wrong one? Ctrl + Z brings it back."),
    },
    {
      id: "next",
      title: gettext("Go to the next frame"),
      text: gettext("Press N. Everybody of this frame comes along, yellow. Move those who walked on, and press E for those who stand right, until nobody is yellow."),
      hint: gettext("F goes to the next yellow person."),
    },
  ];
}

/** One step at a time: what to do, whether it was done well, and what is next. */
export class Tutorial {
  constructor({ api, store, home }) {
    Object.assign(this, { _api: api, _store: store, _home: home });
    this._steps = steps();
    this._index = 0;
    this._timer = null;
    this._asked = 0;
    this._build();
    this._show();
    store.on("change", ({ source }) => source === "edit" && this._soon());
    store.on("frame", () => this._soon());
  }

  _build() {
    this._progress = element("p", { className: "tutorial-progress" });
    this._title = element("h2", {});
    this._text = element("p", {});
    this._hint = element("p", { className: "tutorial-hint" });
    this._verdict = element("p", { className: "tutorial-verdict", role: "status" });
    this._check = element("button", { type: "button", onclick: () => this._ask(true) }, gettext("Check"));
    this._go = element("button", { type: "button", className: "main", hidden: true, onclick: () => this._advance() });
    this.element = element(
      "section",
      { className: "tutorial", "aria-label": gettext("Tutorial") },
      this._progress,
      this._title,
      this._text,
      this._hint,
      this._verdict,
      element("div", { className: "dialog-buttons" }, this._check, this._go),
    );
  }

  _show() {
    const step = this._steps[this._index];
    setText(this._progress, gettext("Tutorial · step {step} of {n}", { step: this._index + 1, n: this._steps.length }));
    setText(this._title, step.title);
    setText(this._text, step.text);
    setText(this._hint, step.hint);
    setText(this._verdict, "");
    this._go.hidden = true;
    this._check.hidden = false;
    this.element.dataset.step = step.id;
    delete this.element.dataset.ok;
  }

  _soon() {
    clearTimeout(this._timer);
    if (this.element.dataset.ok) return;
    this._timer = setTimeout(() => this._ask(false), SETTLED);
  }

  /** `loud`: the annotator pressed Check, so say what is wrong; otherwise only praise unasked. */
  async _ask(loud) {
    const { id } = this._steps[this._index];
    const asked = ++this._asked;
    const annotations = [...this._store.people().values()];
    try {
      const { ok, message } = await this._api.checkTutorial({ step: id, frame: this._store.current, annotations });
      if (asked !== this._asked) return; // an answer to an older question
      if (ok) this._praise(message);
      else if (loud || id === "place") setText(this._verdict, message);
    } catch (error) {
      if (loud) setText(this._verdict, gettext("The answer could not be checked: {error}", { error: error.message }));
    }
  }

  _praise(message) {
    setText(this._verdict, `✓ ${message}`);
    this.element.dataset.ok = "true";
    this._check.hidden = true;
    this._go.hidden = false;
    const last = this._index === this._steps.length - 1;
    setText(this._go, last ? gettext("Finish the tutorial") : gettext("Next step"));
    this._go.focus();
  }

  async _advance() {
    if (this._index < this._steps.length - 1) {
      this._index += 1;
      this._show();
      document.activeElement?.blur();
      return this._ask(false); // it may have been done already
    }
    try {
      await this._api.finishTutorial();
      window.location.assign(this._home);
    } catch (error) {
      setText(this._verdict, error.message);
    }
  }
}
