import { asList, carriedOf } from "./annotation.js";
import * as commands from "./commands.js";
import { Dragging } from "./dragging.js";
import { fetchedDialog } from "./fetched.js";
import { Ghost } from "./ghost.js";
import { Guard } from "./guard.js";
import { Heads } from "./heads.js";
import { keyFor } from "./keys.js";
import { gettext } from "./messages.js";
import { Moving } from "./moving.js";
import { saveWords } from "./save_words.js";
import { Sightings } from "./sightings.js";
import { Sizes } from "./sizes.js";
import { Tour } from "./tour.js";

const DOUBLE = 1000; // ms; the longest double click that systems offer is shorter

/**
 * What an annotator can do, by the ids of the key table and by the pointer's intents. Every edit is a command
 * run by the history; every refusal says why, where the annotator looks.
 */
export class Actions {
  constructor({ scene, store, history, saver, settings, panes, notices, walk }) {
    Object.assign(this, { scene, store, history, saver, settings, panes, notices, walk });
    this.guard = new Guard(this);
    this.heads = new Heads(this);
    this.ghost = new Ghost(this);
    this.sightings = new Sightings(this);
    this.moving = new Moving(this);
    this.sizes = new Sizes(this);
    this.dragging = new Dragging(this);
    this.tour = new Tour(this);
    this._help = fetchedDialog(notices, import.meta.resolve("./help.js"));
    this._settingsDialog = fetchedDialog(notices, import.meta.resolve("./settings_dialog.js"));
    this.setControls = () => {};
    this.afterMove = () => {}; // a right click has put the selected person where it is
  }

  /** @param {KeyboardEvent} [event] of a key; a button has none */
  perform(id, event = null) {
    this._table ??= this._makeTable();
    this._table[id]?.(event);
  }

  /** Actions of other topics, in the same form. */
  use(table) {
    Object.assign((this._table ??= this._makeTable()), table);
  }

  _makeTable() {
    return {
      ...this.moving.table(),
      ...this.sizes.table(),
      validate: () => this.validate(),
      validateAll: () => this.validateAll(),
      validateNext: () => this.validate() && this.selectCarried(),
      remove: () => this.remove(),
      moveHere: () => this.moveUnderPointer(),
      heads: () => this.heads.toggle(),
      nextPerson: () => this.selectNeighbour(1),
      previousPerson: () => this.selectNeighbour(-1),
      nextCarried: () => this.selectCarried(),
      nextFrame: () => this.walk.next(),
      previousFrame: () => this.walk.previous(),
      reload: () => this.walk.reload(),
      save: () => this.save(),
      zoom: () => this.toggleZoom(),
      outline: () => this.settings.set("outline", !this.settings.get("outline")),
      grid: () => this.settings.set("grid", !this.settings.get("grid")),
      directions: () => this.settings.set("directions", !this.settings.get("directions")),
      help: async () => (await this._help())?.showHelp(this.settings),
      settings: async () => (await this._settingsDialog())?.showSettings(this.settings),
      controls: () => this.setControls(true),
      escape: () => this.escape(),
    };
  }

  // Pointer intents

  place(pane, at, event) {
    const { selection } = this.store;
    this._placed = this.moving.place(pane, at, event) ? { pane, time: event.timeStamp, selection } : null;
  }

  /** A view was clicked twice: whom the first click has placed is taken back. */
  enlarge(pane, event) {
    if (this._placed?.pane === pane && event.timeStamp - this._placed.time < DOUBLE) {
      this.history.undo();
      this.store.select(this._placed.selection);
    }
    this._placed = null;
    this.views.enlarge(pane);
  }

  moveHere(pane, at, event) {
    if (this.moving.moveHere(pane, at, event)) this.afterMove();
  }

  /** What a right click does, by a key. */
  moveUnderPointer() {
    if (this.dragging.active) return;
    const under = this.pointer.under();
    if (!under) return this.notices.say(gettext("Point at the feet in one of the views"));
    this.moveHere(under.pane, under.at, under.event);
  }

  /** Clicks mean heads: what a box covers can be clicked on, and nobody is taken hold of. */
  get pointsThrough() {
    return this.heads.active;
  }

  sight(pane, at, event) {
    this.moving.sight(pane, at, event);
  }

  /** @param {object|null} over who is under the pointer */
  hover(pane, at, over) {
    this.ghost.hover(pane, at, over);
  }

  leave() {
    this.ghost.hide();
  }

  /** @param {"foot"|"top"} part @returns {boolean} whether they can be dragged */
  beginDrag(pane, at, person, part, event) {
    this.ghost.hide();
    return this.dragging.begin(pane, at, person, part, event);
  }

  drag(at) {
    this.dragging.move(at);
  }

  drop() {
    this.dragging.drop();
  }

  cancelDrag() {
    this.dragging.cancel();
  }

  select(person) {
    this.ghost.hide();
    this.store.select(person);
  }

  // Keys

  validate() {
    const person = this.guard.selected();
    if (!person) return false;
    if (person.state === "carried") this.history.run(commands.validate(this.store, [person.person]));
    return true;
  }

  validateAll() {
    const persons = carriedOf(this.store.people()).map(({ person }) => person);
    if (this.guard.refused()) return false;
    if (persons.length) this.history.run(commands.validate(this.store, persons));
    return true;
  }

  remove() {
    const person = this.guard.selected();
    if (!person) return false;
    this.history.run(commands.remove(this.store, person.person));
    this.notices.say(gettext("Person {person} removed – {key} brings it back", { person: person.person, key: keyFor("undo") }));
    return true;
  }

  selectNeighbour(offset) {
    const people = asList(this.store.people());
    if (!people.length) return this.notices.say(gettext("Nobody is marked in this frame yet: click on somebody's feet"));
    const index = people.findIndex(({ person }) => person === this.store.selection);
    const from = index < 0 && offset < 0 ? 0 : index;
    this.select(people[(from + offset + people.length) % people.length].person);
  }

  selectCarried() {
    const next = this.tour.next(this.store.selection);
    if (!next) return this.notices.say(gettext("Nobody is yellow in this frame"));
    this.select(next.person);
  }

  async save() {
    const saved = await this.saver.flush();
    this.notices.say(saved ? gettext("Everything is saved") : saveWords(this.saver.status(), null).text);
  }

  toggleZoom() {
    if (!this.panes.zoomed && !this.store.selected()) return this.guard.sayNobodySelected();
    this.panes.zoom(!this.panes.zoomed);
  }

  escape() {
    this.setControls(false);
    if (this.dragging.cancel()) return;
    if (this.heads.active) return this.heads.toggle(false);
    if (this.panes.zoomed) return this.panes.zoom(false);
    this.store.select(null);
  }
}
