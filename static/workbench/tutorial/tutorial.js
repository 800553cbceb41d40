import { element, setText } from "../../base/dom.js";
import { failureWords } from "../../base/failure_words.js";
import { gettext } from "../../base/messages.js";
import { annotation } from "../../truth/annotation.js";
import { Spotlight } from "../../views/spotlight.js";
import { keyFor } from "../keys/keys.js";
import { adviceFor, presses } from "./advice.js";
import { tutorialSteps, whatMatters } from "./tutorial_steps.js";

/**
 * @typedef {import("../../base/answers.js").Verdict} Verdict
 * @typedef {import("../../views/pane.js").Pane} Pane
 */

const SETTLED = 600; // ms without an edit before the server is asked
const ENOUGH = 3; // misses after which the place is shown
const UNDONE = 20; // steps at most that a wrong first click is taken back by
const QUIET = new Set(["nothing", "frame"]); // not done yet is no mistake

/**
 * One step at a time: what to do, whether it was done well, and what is next. One can go back to a step, and
 * start over; nothing is saved here but that a step was done.
 */
export class Tutorial {
  /**
   * @param {object} parts
   * @param {import("../../base/api.js").Api} parts.api
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {import("../../truth/history.js").History} parts.history
   * @param {import("../../views/panes.js").Panes} parts.panes
   * @param {import("../frames/navigation.js").Navigation} parts.navigation
   * @param {string} parts.home
   */
  constructor({ api, store, history, panes, navigation, home }) {
    this._api = api;
    this._store = store;
    this._history = history;
    this._panes = panes;
    this._navigation = navigation;
    this._home = home;
    this._spotlight = new Spotlight(panes);
    this._index = 0;
    this._misses = 0; // in this step
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
    this._check = element(
      "button",
      { type: "button", onclick: () => this._ask({ loud: true, all: true }) },
      gettext("Check"),
    );
    this._go = element("button", { type: "button", className: "main", hidden: true, onclick: () => this._advance() });
    this.element = this._build();
    store.on("change", ({ source }) => source === "edit" && this._soon(true));
    store.on("frame", () => this._soon(false));
  }

  /** Asked for anew each time: the keys named in them can be changed. */
  get _steps() {
    return tutorialSteps();
  }

  /** Once the page is there. */
  start() {
    this._show();
    this._ask({});
  }

  _build() {
    return element(
      "section",
      { className: "tutorial", "aria-label": gettext("Tutorial"), onkeydown: keepForButtons },
      element("div", { className: "tutorial-head" }, this._progress, this._back, this._again),
      element("div", { className: "tutorial-text" }, this._title, this._text, this._matters, this._hint),
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
    this._say("");
    this._verdict.hidden = false;
    this._misses = 0;
    this._matters.hidden = true;
    this._go.hidden = true;
    this._check.hidden = false;
    this._back.hidden = this._index === 0;
    this.element.dataset.step = step.id;
    delete this.element.dataset.ok;
    this._spotlight.show(step.light);
  }

  /** @param {boolean} loud */
  _soon(loud) {
    clearTimeout(this._timer);
    if (this.element.dataset.ok) return;
    this._timer = setTimeout(() => this._ask({ loud }), SETTLED);
  }

  /**
   * `loud`: something was done, so say what is wrong about it; `all`: also that nothing was done yet.
   * @param {{loud?: boolean, all?: boolean}} how
   */
  async _ask({ loud = false, all = false }) {
    const { id } = this._steps[this._index];
    const asked = ++this._asked;
    const annotations = [...this._store.people().values()];
    try {
      const verdict = await this._api.checkTutorial({ step: id, frame: this._store.current, annotations });
      if (asked !== this._asked) return; // an answer to an older question
      if (verdict.ok) return this._praise(verdict.message);
      const quiet = !verdict.mistake || QUIET.has(verdict.mistake);
      if (loud && !quiet) this._correct(verdict);
      else if (all) this._say(verdict.message);
      this._point(verdict);
    } catch (error) {
      if (loud) this._say(gettext("The answer could not be checked: {error}", { error: failureWords(error) }));
    }
  }

  /** @param {string} message */
  _say(message) {
    setText(this._verdict, message);
    this._hint.hidden = message !== ""; // there is room for one of them
  }

  /** What was wrong, and which way it goes. @param {Verdict} verdict */
  _correct(verdict) {
    this._misses += 1;
    const { person, mistake, message } = verdict;
    this._say(`${message} ${this._advice(verdict)}`.trim());
    if (mistake !== "body" && mistake !== "other") return;
    for (let left = UNDONE; left && person !== null && this._store.people().has(person); left--) this._history.undo();
  }

  /** @param {Verdict} verdict */
  _advice({ person, feet, mistake }) {
    if (this._misses >= ENOUGH && feet !== null)
      return gettext("The dashed ring lies where the feet are: click into it with the right button.");
    const one = person === null ? undefined : this._store.people().get(person);
    if (!one || feet === null || (mistake !== "off" && mistake !== "head")) return "";
    const pane = [this._panes.active, ...this._panes.shown].find(({ view }) => isCamera(view) && view.box(one));
    const axes = pane?.view.axes(one);
    if (!pane || !axes) return "";
    const { columns } = this._panes.scene.grid;
    const [from, to] = [one.position, feet].map((place) => [place % columns, Math.floor(place / columns)]);
    return adviceFor(presses(axes, to[0] - from[0], to[1] - from[1]), pane.view.title, keyFor);
  }

  /** Who is meant, and which way it goes. @param {Verdict} verdict */
  _point({ person, feet }) {
    const { id, light } = this._steps[this._index];
    if (feet === null) return this._spotlight.show(light);
    const there = person === null ? undefined : this._store.people().get(person);
    const view = id === "place" && !there ? this._bestView(feet) : null;
    const from = there && this._misses > 0 ? there.position : null;
    const target = { position: feet, view, from, shown: this._misses >= ENOUGH };
    this._spotlight.show({ ...light, parts: view ? `[data-view="${view}"]` : light.parts, target });
  }

  /** The view in which somebody there is seen largest. @param {number} position */
  _bestView(position) {
    const somebody = annotation({ person: -1, position });
    const tall = this._panes.shown.flatMap(({ view }) => {
      const box = isCamera(view) ? view.box(somebody) : null;
      const { width, height } = view.size;
      const whole = box && box.xmin >= 0 && box.ymin >= 0 && box.xmax < width && box.ymax < height;
      return box && whole ? [{ id: view.id, height: box.ymax - box.ymin }] : [];
    });
    tall.sort((one, other) => other.height - one.height);
    return tall[0]?.id ?? null;
  }

  /** @param {string} message */
  _praise(message) {
    const last = this._index === this._steps.length - 1;
    this._say(`✓ ${message}`);
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
    setText(this._title, gettext("✓ Right. What is looked at in your work:"));
    this._verdict.hidden = true; // the title says it
    setText(this._text, "");
    this._matters.hidden = false;
  }

  async _advance() {
    if (this._index < this._steps.length - 1) return this._goTo(this._index + 1);
    try {
      await this._api.finishTutorial();
      window.location.assign(this._home);
    } catch (error) {
      this._say(gettext("Not finished yet: {reason}", { reason: failureWords(error) }));
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
    return this._ask({});
  }
}

/** @param {import("../../views/pane.js").View} view */
function isCamera({ id }) {
  return id.startsWith("camera");
}

/**
 * Enter and Space on a button of the tutorial press it, instead of going to people.
 * @param {KeyboardEvent} event
 */
function keepForButtons(event) {
  if (event.target instanceof Element && event.target.closest("button") && ["Enter", " "].includes(event.key))
    event.stopPropagation();
}
