import { element, setText } from "../../base/dom.js";
import { failureWords } from "../../base/failure_words.js";
import { gettext } from "../../base/messages.js";
import { Spotlight } from "../../views/spotlight.js";
import { tutorialSteps, whatMatters } from "./tutorial_steps.js";

const SETTLED = 600; // ms without an edit before the server is asked

/**
 * One step at a time: what to do, whether it was done well, and what is next. One can go back to a step, and
 * start over; nothing is saved here but that a step was done.
 */
export class Tutorial {
  /**
   * @param {object} parts
   * @param {import("../../base/api.js").Api} parts.api
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {import("../../views/panes.js").Panes} parts.panes
   * @param {import("../frames/navigation.js").Navigation} parts.navigation
   * @param {string} parts.home
   */
  constructor({ api, store, panes, navigation, home }) {
    this._api = api;
    this._store = store;
    this._navigation = navigation;
    this._home = home;
    this._spotlight = new Spotlight(panes);
    this._index = 0;
    /** @type {ReturnType<typeof setTimeout>|undefined} */
    this._timer = undefined;
    this._asked = 0;
    this._progress = element("p", { className: "tutorial-progress" });
    this._title = element("h2", { tabIndex: -1 });
    this._text = element("p", {});
    this._matters = element(
      "ul",
      { className: "tutorial-matters", hidden: true },
      whatMatters().map((text) => element("li", {}, text)),
    );
    this._hint = element("p", { className: "tutorial-hint" });
    this._verdict = element("p", { className: "tutorial-verdict", role: "status" });
    this._back = element(
      "button",
      { type: "button", className: "quiet", onclick: () => this._goBack() },
      gettext("Back"),
    );
    this._again = element(
      "button",
      { type: "button", className: "quiet", onclick: () => window.location.reload() },
      gettext("Start over"),
    );
    this._check = element("button", { type: "button", onclick: () => this._ask(true) }, gettext("Check"));
    this._go = element("button", { type: "button", className: "main", hidden: true, onclick: () => this._advance() });
    this.element = this._build();
    store.on("change", ({ source }) => source === "edit" && this._soon());
    store.on("frame", () => this._soon());
  }

  /** Asked for anew each time: the keys named in them can be changed. */
  get _steps() {
    return tutorialSteps();
  }

  /** Once the page is there. */
  start() {
    this._show();
  }

  _build() {
    return element(
      "section",
      { className: "tutorial", "aria-label": gettext("Tutorial"), onkeydown: keepForButtons },
      element("div", { className: "tutorial-head" }, this._progress, this._back, this._again),
      this._title,
      this._text,
      this._matters,
      this._hint,
      this._verdict,
      element("div", { className: "tutorial-buttons" }, this._check, this._go),
    );
  }

  _show() {
    const step = this._steps[this._index];
    setText(this._progress, gettext("Tutorial · step {step} of {n}", { step: this._index + 1, n: this._steps.length }));
    setText(this._title, step.title);
    setText(this._text, step.text);
    setText(this._hint, step.hint);
    setText(this._verdict, "");
    this._matters.hidden = true;
    this._go.hidden = true;
    this._check.hidden = false;
    this._back.hidden = this._index === 0;
    this.element.dataset.step = step.id;
    delete this.element.dataset.ok;
    this._spotlight.show(step.light);
  }

  _soon() {
    clearTimeout(this._timer);
    if (this.element.dataset.ok) return;
    this._timer = setTimeout(() => this._ask(true), SETTLED);
  }

  /**
   * `loud`: something was done, so say what is still wrong; otherwise only praise.
   * @param {boolean} loud
   */
  async _ask(loud) {
    const { id } = this._steps[this._index];
    const asked = ++this._asked;
    const annotations = [...this._store.people().values()];
    try {
      const { ok, message } = await this._api.checkTutorial({ step: id, frame: this._store.current, annotations });
      if (asked !== this._asked) return; // an answer to an older question
      if (ok) this._praise(message);
      else if (loud) setText(this._verdict, message);
    } catch (error) {
      if (loud)
        setText(this._verdict, gettext("The answer could not be checked: {error}", { error: failureWords(error) }));
    }
  }

  /** @param {string} message */
  _praise(message) {
    const last = this._index === this._steps.length - 1;
    setText(this._verdict, `✓ ${message}`);
    setText(this._hint, "");
    this.element.dataset.ok = "true";
    this._check.hidden = true;
    this._go.hidden = false;
    setText(this._go, last ? gettext("Finish the tutorial") : gettext("Next step"));
    this._spotlight.show({});
    if (last) this._close();
    this._go.focus();
  }

  /** The last word: what is paid attention to. */
  _close() {
    setText(this._title, gettext("That is all you need. What is looked at in your work:"));
    setText(this._text, "");
    this._matters.hidden = false;
  }

  async _advance() {
    if (this._index < this._steps.length - 1) return this._goTo(this._index + 1);
    try {
      await this._api.finishTutorial();
      window.location.assign(this._home);
    } catch (error) {
      setText(this._verdict, gettext("Not finished yet: {reason}", { reason: failureWords(error) }));
    }
  }

  async _goBack() {
    const index = this._index - 1;
    const number = this._store.numbers[this._steps[index].frame];
    if (this._store.current !== number) await this._navigation.jump(number);
    await this._goTo(index);
  }

  /**
   * It may have been done already.
   * @param {number} index
   */
  _goTo(index) {
    clearTimeout(this._timer);
    this._asked += 1;
    this._index = index;
    this._show();
    if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
    return this._ask(false);
  }
}

/**
 * Enter and Space on a button of the tutorial press it, instead of going to people.
 * @param {KeyboardEvent} event
 */
function keepForButtons(event) {
  if (event.target instanceof Element && event.target.closest("button") && ["Enter", " "].includes(event.key))
    event.stopPropagation();
}
