import { gettext } from "../../base/messages.js";
import { changed } from "../../truth/annotation.js";
import * as commands from "../../truth/commands.js";
import { spotOn } from "../../truth/ground_point.js";
import { freePosition } from "../../truth/propagation.js";
import { keyFor } from "../keys/keys.js";
import { DIRECTIONS } from "./directions.js";

const FAR = 10; // positions a step with Shift goes

/**
 * Placing people and moving them, by click and by arrow key.
 * @typedef {import("../../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../../truth/ground_point.js").XY} XY
 * @typedef {import("../../truth/scene.js").Scene} Scene
 * @typedef {import("../../truth/store.js").Store} Store
 * @typedef {import("../../views/pane.js").Pane} Pane
 * @typedef {import("./directions.js").Direction} Direction
 * @typedef {import("./guard.js").Where} Where
 * @typedef {(event: KeyboardEvent|null) => void} Row what a key does; a button has no event
 */
export class Moving {
  /**
   * @param {object} parts
   * @param {Scene} parts.scene
   * @param {Store} parts.store
   * @param {import("../../truth/history.js").History} parts.history
   * @param {import("./guard.js").Guard} parts.guard
   * @param {import("./ghost.js").Ghost} parts.ghost
   * @param {import("./multi_view_click.js").MultiViewClick} parts.multiViewClick
   * @param {import("./heads.js").Heads} parts.heads
   * @param {import("./directions.js").Arrows} parts.arrows
   * @param {import("../keys/key_repeat.js").KeyRepeat} parts.held
   */
  constructor({ scene, store, history, guard, ghost, multiViewClick, heads, arrows, held }) {
    this.scene = scene;
    this.store = store;
    this.history = history;
    this.guard = guard;
    this.ghost = ghost;
    this.multiViewClick = multiViewClick;
    this.heads = heads;
    this._arrows = arrows;
    this._held = held;
  }

  /** Rows for the table of actions. */
  table() {
    /** @type {Record<string, Row>} */
    const rows = {};
    for (const name of DIRECTIONS) {
      rows[name] = (event) => this.step(name, event);
      rows[`${name}Far`] = (event) => this.step(name, event, FAR);
    }
    return rows;
  }

  /**
   * @param {Pane} pane @param {XY} at CSS pixels of the pane @param {Where} event where a refusal is said
   * @returns {boolean} whether somebody new stands there now
   */
  place(pane, at, event) {
    const position = this.guard.refused(event) ? null : this._positionUnder(pane, at, event, null);
    if (position === null) return false;
    const occupant = this.store.occupant(position);
    if (occupant) {
      this.guard.say(event, gettext("Person {person} stands exactly here", { person: occupant.person }));
      return false;
    }
    this.ghost.hide();
    this.history.run(commands.place(this.store, { position }));
    this.multiViewClick.begin(pane, this.heads.pixel(pane, at, null));
    return true;
  }

  /**
   * @param {Pane} pane @param {XY} at @param {Where} event
   * @returns {boolean} whether the selected person stands there now
   */
  moveHere(pane, at, event) {
    const person = this.guard.selected(event);
    const position = person && this._positionUnder(pane, at, event, person);
    if (!person || position === null || !this.moveTo(person, position, event)) return false;
    this.ghost.hide();
    this.multiViewClick.begin(pane, this.heads.pixel(pane, at, person));
    return true;
  }

  /**
   * The feet of the selected person once more, in another view.
   * @param {Pane} pane @param {XY} at @param {Where} event
   */
  sight(pane, at, event) {
    if (this.guard.refused(event)) return;
    const refusal = this.heads.refusal(pane);
    if (refusal) return this.guard.say(event, refusal);
    if (pane.view.index === null)
      return this.guard.say(event, gettext("The map sees from nowhere: click the feet in a camera's view"));
    const person = this.store.selected();
    if (!person) return void this.place(pane, at, event);
    const pixel = this.heads.pixel(pane, at, person);
    if (this.multiViewClick.add(pane, pixel, event, (position) => this.moveTo(person, position, event))) return;
    if (this.moveHere(pane, at, event))
      this.guard.say(event, gettext("Now Alt + click on the same feet in another view"));
  }

  /** @param {Direction} name @param {KeyboardEvent|null} event @param {number|null} [far] positions, if not as many as the key's pace */
  step(name, event, far = null) {
    const person = this.guard.selected();
    if (!person) return;
    const step = this._held.press(name, event, () => this._arrows.steps(person))[name];
    const beside = () => this.guard.besideFoot(person);
    for (let cells = far ?? this._held.pace; cells > 0; cells = far ? 0 : cells - 1) {
      const position = this._steppedFree(person, step, cells);
      if (position !== null) return this.moveTo(person, position, beside);
    }
    this.guard.say(beside, gettext("The ground area ends here"));
  }

  /**
   * @param {Annotation} person @param {number} position @param {Where} place
   * @returns {boolean} whether the person stands there now
   */
  moveTo(person, position, place) {
    const occupant = this.store.occupant(position, person.person);
    if (occupant) {
      this.guard.say(place, gettext("Person {person} stands there already", { person: occupant.person }));
      return false;
    }
    if (position !== person.position || person.state !== "validated") {
      this.history.run(commands.move(this.store, person.person, position));
    }
    return true;
  }

  /**
   * So many positions further, and past whoever stands exactly there: a press is never lost on a neighbour.
   * @param {Annotation} person @param {import("./directions.js").Step} step @param {number} cells
   * @returns {number|null} null: outside the ground area
   */
  _steppedFree(person, { columns, rows }, cells) {
    for (let far = cells; ; far += 1) {
      const position = this.scene.stepped(person.position, columns * far, rows * far);
      if (position === null || !this.store.occupant(position, person.person)) return position;
    }
  }

  /** @param {Pane} pane @param {XY} at @param {Where} event @param {Annotation|null} person */
  _positionUnder(pane, at, event, person) {
    const refusal = this.heads.refusal(pane);
    if (refusal) this.guard.say(event, refusal);
    if (refusal) return null;
    const { position, problem } = spotOn(this.scene, this.store, this.heads.ground(pane, at, person));
    if (problem === "horizon" && pane.view.byTable)
      this.guard.say(event, gettext("Nobody in the ground area would have their feet here"));
    else if (problem === "horizon" && this.heads.active)
      this.guard.say(event, gettext("No head can be here: the line of sight never comes down to it"));
    else if (problem === "horizon")
      this.guard.say(event, gettext("Above the horizon there is no ground: click where the feet are"));
    if (problem === "outside")
      this.guard.say(event, gettext("Outside the ground area – {key} shows its border", { key: keyFor("outline") }));
    return position;
  }
}

/**
 * Where a person lands who is dragged to a ground point: on the grid, on no one's toes.
 * @param {Scene} scene @param {Store} store @param {Annotation} person @param {XY} ground
 */
export function landing(scene, store, person, ground) {
  const taken = new Set([...store.people().values()].filter((one) => one !== person).map(({ position }) => position));
  const position = freePosition(scene.grid, ground, taken);
  return position === person.position ? person : changed(person, { position });
}
