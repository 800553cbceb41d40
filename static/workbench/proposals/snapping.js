/**
 * @typedef {import("../../base/answers.js").SnapAnswer} SnapAnswer
 * @typedef {object} Parts
 * @property {import("../../base/api.js").Api} api
 * @property {import("../../truth/store.js").Store} store
 * @property {import("../../truth/history.js").History} history
 * @property {import("../../truth/scene.js").Scene} scene
 * @property {{say: (text: string) => void}} notices
 * @property {import("../placing/guard.js").Guard} guard
 */
import { gettext } from "../../base/messages.js";
import { move } from "../../truth/commands.js";
import { keyFor } from "../keys/keys.js";

/** @type {Record<SnapAnswer["refused"], () => string>} */
const WHY = {
  "": () => "",
  unseen: () => gettext("No program has looked at this frame, so nobody knows better"),
  nothing: () => gettext("No view shows anybody here whom nobody else explains"),
  small: () => gettext("As far as the views show, this is where the person stands"),
  near: () => gettext("Somebody else stands where the views show this person"),
};

/**
 * Somebody marked roughly moves to where the views show them: by a key, and by itself after a click or a drag, unless
 * Shift is held. The move is a step of its own, so that one undo brings back the place that was clicked.
 */
export class Snapping {
  /** @param {Parts} parts */
  constructor({ api, store, history, scene, notices, guard }) {
    this._api = api;
    this._store = store;
    this._history = history;
    this._scene = scene;
    this._notices = notices;
    this._guard = guard;
    this._fresh = false; // nothing was done since the last move
    history.on("change", () => (this._fresh = false));
  }

  /** Rows for the table of actions. */
  table() {
    return { snap: () => this._selected() };
  }

  async _selected() {
    const person = this._guard.selected();
    if (!person) return;
    const answer = await this._snap(person.person);
    if (answer === null) this._notices.say(gettext("The server does not answer, so the person stays where it is"));
    else if (answer?.refused) this._notices.say(WHY[answer.refused]());
  }

  /** By itself: where it cannot be told better nothing is said. @param {number} person */
  async settle(person) {
    if (this._guard.editable) await this._snap(person);
  }

  /** The first click of two was not meant: what came of it goes before the click itself does. */
  takeBack() {
    if (this._fresh) this._history.undo();
  }

  /**
   * @param {number} person
   * @returns {Promise<SnapAnswer|null|undefined>} null: no answer; undefined: something else was done meanwhile
   */
  async _snap(person) {
    const { current } = this._store;
    const before = this._store.person(person, current);
    if (!before) return undefined;
    const everybody = [...this._store.people().values()];
    const others = everybody.filter((one) => one.person !== person).map(asMark);
    const body = { frame: current, ...asMark(before), others };
    /** @type {SnapAnswer|null} */
    const answer = await this._api.ask("POST", "snap/", body).catch(() => null);
    const now = this._store.current === current && this._store.person(person, current);
    if (!now || now.position !== before.position) return undefined;
    if (answer && !answer.refused) this._move(person, before.position, answer);
    return answer;
  }

  /** @param {number} person @param {number} from @param {SnapAnswer} answer */
  _move(person, from, { position, background }) {
    if (position === from || this._store.occupant(position, person)) return;
    const { selection } = this._store;
    const label = gettext("move person {person} to where the views show it", { person });
    const step = { ...move(this._store, person, position), label, group: null };
    this._history.run({ ...step, selection: { before: selection, after: selection } });
    this._fresh = true;
    const [one, other] = [this._scene.metres(from), this._scene.metres(position)];
    const cm = Math.round(100 * Math.hypot(one.x - other.x, one.y - other.y));
    const words = { cm, key: keyFor("undo") };
    const said = background
      ? gettext("Moved by {cm} cm to where the views show the person – {key} takes it back", words)
      : gettext("Moved by {cm} cm by the boxes alone: this run kept no background – {key} takes it back", words);
    this._notices.say(said);
  }
}

/** @param {import("../../truth/annotation.js").Annotation} one */
function asMark({ position, height }) {
  return { position, height };
}

/**
 * Clicks, right clicks and drags settle; with Shift held they mean exactly where they are.
 * @param {import("../../views/intents.js").Intents} intents @param {Snapping} snapping
 * @param {import("../../truth/store.js").Store} store
 */
export function settleAfter(intents, snapping, store) {
  let exact = false;
  window.addEventListener("pointerup", (event) => (exact = event.shiftKey), true);
  for (const name of /** @type {const} */ (["place", "moveHere", "drop"])) {
    const act = /** @type {(...given: unknown[]) => unknown} */ (intents[name].bind(intents));
    Object.assign(intents, {
      /** @param {unknown[]} given */
      [name](...given) {
        const before = new Map([...store.people()].map(([person, { position }]) => [person, position]));
        const frame = store.current;
        act(...given);
        if (exact || store.current !== frame) return;
        for (const { person, position, origin } of store.people().values())
          if (before.get(person) !== position && origin === "clicked") snapping.settle(person);
      },
    });
  }
  const enlarge = intents.enlarge.bind(intents);
  intents.enlarge = (pane, event) => {
    snapping.takeBack();
    enlarge(pane, event);
  };
}
