import { annotation, carriedOf, asList } from "./annotation.js";
import { copyPeople } from "./carry.js";
import * as commands from "./commands.js";
import { arrowSteps } from "./directions.js";
import { showHelp } from "./help.js";
import { gettext, ngettext } from "./messages.js";
import { showSettings } from "./settings_dialog.js";

const FAR = 10; // positions a step with Shift goes

/**
 * What an annotator can do, by the ids of the key table and by the pointer's intents. Every edit is a command
 * run by the history; every refusal says why, where the annotator looks.
 */
export class Actions {
  constructor({ scene, store, history, saver, settings, panes, notices, walk }) {
    Object.assign(this, { scene, store, history, saver, settings, panes, notices, walk });
    this.setControls = () => {};
  }

  /** @param {KeyboardEvent} [event] of a key; a button has none */
  perform(id, event = null) {
    this._table ??= this._makeTable();
    this._table[id]?.(event);
  }

  _makeTable() {
    const arrows = ["left", "right", "up", "down"].flatMap((name) => [
      [name, () => this.step(name, 1)],
      [`${name}Far`, () => this.step(name, FAR)],
    ]);
    return {
      ...Object.fromEntries(arrows),
      validate: () => this.validate(),
      validateNext: () => this.validate() && this.selectCarried(),
      remove: () => this.remove(),
      nextPerson: () => this.selectNeighbour(1),
      previousPerson: () => this.selectNeighbour(-1),
      nextCarried: () => this.selectCarried(),
      nextFrame: () => this.walk.next(),
      previousFrame: () => this.walk.previous(),
      bring: () => this.bring(),
      reload: () => this.walk.reload(),
      save: () => this.save(),
      zoom: () => this.toggleZoom(),
      outline: () => this.panes.set("outline", !this.panes.options.outline),
      directions: () => this.panes.set("directions", !this.panes.options.directions),
      undo: () => this.undo(),
      redo: () => this.redo(),
      help: () => showHelp(),
      settings: () => showSettings(this.settings),
      controls: () => this.setControls(true),
      escape: () => this.escape(),
    };
  }

  // Pointer intents

  place(pane, at, event) {
    if (this._refusedToEdit(event)) return;
    const position = this._positionUnder(pane, at, event);
    if (position === null) return;
    const occupant = this.store.occupant(position);
    if (occupant) return this._say(event, gettext("Person {person} stands exactly here", { person: occupant.person }));
    this.panes.showGhost(null);
    this.history.run(commands.place(this.store, { position }));
  }

  select(person) {
    this.panes.showGhost(null);
    this.store.select(person);
  }

  moveHere(pane, at, event) {
    const person = this._selectedForEdit(event);
    const position = person && this._positionUnder(pane, at, event);
    if (person && position !== null) this._moveTo(person, position, event);
  }

  /** What a click would place, shown in every other view. */
  hover(pane, at) {
    const ground = this._canPlace(pane, at) ? pane.view.ground(pane.transform.toSource(at.x, at.y)) : null;
    const position = ground && this.scene.positionAt(ground);
    if (position === null) return this.panes.showGhost(null);
    if (this.panes.ghost?.annotation.position === position) return;
    const look = this.store.occupant(position) ? "refused" : "ghost";
    this.panes.showGhost({ annotation: annotation({ person: null, position }), look });
  }

  leave() {
    this.panes.showGhost(null);
  }

  // Keys

  step(name, cells) {
    const person = this._selectedForEdit();
    if (!person) return;
    const { columns, rows } = arrowSteps(this.panes, person)[name];
    const position = this.scene.stepped(person.position, columns * cells, rows * cells);
    if (position === null) return this._say(this._besideFoot(person), gettext("The ground area ends here"));
    this._moveTo(person, position, this._besideFoot(person));
  }

  validate() {
    const person = this._selectedForEdit();
    if (!person) return false;
    if (person.state === "carried") this.history.run(commands.validate(this.store, [person.person]));
    return true;
  }

  validateAll() {
    const persons = carriedOf(this.store.people()).map(({ person }) => person);
    if (persons.length && !this._refusedToEdit()) this.history.run(commands.validate(this.store, persons));
  }

  remove() {
    const person = this._selectedForEdit();
    if (!person) return;
    this.history.run(commands.remove(this.store, person.person));
    this.notices.say(gettext("Person {person} removed – Ctrl + Z brings it back", { person: person.person }));
  }

  selectNeighbour(offset) {
    const people = asList(this.store.people());
    if (!people.length) return this.notices.say(gettext("Nobody is marked in this frame yet: click on somebody's feet"));
    const index = people.findIndex(({ person }) => person === this.store.selection);
    const from = index < 0 && offset < 0 ? 0 : index;
    this.select(people[(from + offset + people.length) % people.length].person);
  }

  selectCarried() {
    const waiting = carriedOf(this.store.people());
    if (!waiting.length) return this.notices.say(gettext("Nobody is yellow in this frame"));
    const next = waiting.find(({ person }) => person > (this.store.selection ?? -1)) ?? waiting[0];
    this.select(next.person);
  }

  bring() {
    if (this._refusedToEdit()) return;
    const before = this.store.neighbour(-1);
    if (before === undefined) return this.notices.say(gettext("This is the first frame"));
    const missing = copyPeople(this.store.people(before), { except: this.store.people(), origin: "copied" });
    if (!missing.length) return this.notices.say(gettext("Everybody of the previous frame is here already"));
    this.history.run(commands.bring(this.store, this.store.current, missing));
    this.notices.say(ngettext("{n} person loaded from the previous frame", "{n} people loaded from the previous frame", missing.length));
  }

  async save() {
    const saved = await this.saver.flush();
    if (saved) this.notices.say(gettext("Everything is saved"));
  }

  toggleZoom() {
    if (!this.panes.zoomed && !this.store.selected()) return this._sayNobodySelected();
    this.panes.zoom(!this.panes.zoomed);
  }

  undo() {
    if (!this._refusedToEdit()) this._afterStep(this.history.undo(), gettext("Nothing to undo"), (label) => gettext("Undone: {label}", { label }));
  }

  redo() {
    if (!this._refusedToEdit()) this._afterStep(this.history.redo(), gettext("Nothing to redo"), (label) => gettext("Done again: {label}", { label }));
  }

  escape() {
    this.setControls(false);
    if (this.panes.zoomed) return this.panes.zoom(false);
    this.store.select(null);
  }

  _afterStep(step, nothing, sentence) {
    if (!step) return this.notices.say(nothing);
    const said = sentence(step.patch.label);
    if (!step.skipped) return this.notices.say(said);
    this.notices.say(`${said} – ${gettext("except what was changed elsewhere since")}`);
  }

  _moveTo(person, position, place) {
    const occupant = this.store.occupant(position, person.person);
    if (occupant) return this._say(place, gettext("Person {person} stands there already", { person: occupant.person }));
    if (position === person.position && person.state === "validated") return;
    this.history.run(commands.move(this.store, person.person, position));
  }

  _positionUnder(pane, at, event) {
    const ground = pane.view.ground(pane.transform.toSource(at.x, at.y));
    if (!ground) {
      this._say(event, gettext("Above the horizon there is no ground: click where the feet are"));
      return null;
    }
    const position = this.scene.positionAt(ground);
    if (position === null) this._say(event, gettext("Outside the ground area – T shows its border"));
    return position;
  }

  _canPlace(pane, at) {
    return this.saver.readOnly === null && pane.transform !== null && at.x >= 0 && at.y >= 0;
  }

  _selectedForEdit(event = null) {
    if (this._refusedToEdit(event)) return null;
    const person = this.store.selected();
    if (!person) this._sayNobodySelected(event);
    return person ?? null;
  }

  _sayNobodySelected(event = null) {
    this._say(event, gettext("Nobody is selected: click on a box, or press Tab"));
  }

  _refusedToEdit(event = null) {
    if (this.saver.readOnly === null) return false;
    this._say(event, gettext("Read-only: {reason}", { reason: this.saver.readOnly }));
    return true;
  }

  /** A place in the window for a message: of a pointer event, or as given. */
  _say(place, text) {
    this.notices.sayAt(place && "clientX" in place ? { x: place.clientX, y: place.clientY } : place, text);
  }

  _besideFoot(person) {
    const pane = this.panes.active;
    const foot = pane.view.box(person) && pane.view.foot(person);
    if (!foot) return null;
    const { x, y } = pane.transform.toPane(foot.x, foot.y);
    const bounds = pane.element.getBoundingClientRect();
    return { x: bounds.left + x, y: bounds.top + y };
  }
}
