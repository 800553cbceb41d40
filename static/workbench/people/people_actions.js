import { gettext } from "../../base/messages.js";
import { asList, carriedOf } from "../../truth/annotation.js";
import * as commands from "../../truth/commands.js";
import { keyFor } from "../keys/keys.js";

/** Choosing, validating and removing people of the open frame. Every refusal says why, where the annotator looks. */
export class PeopleActions {
  /**
   * @param {object} parts
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {import("../../truth/history.js").History} parts.history
   * @param {import("../placing/guard.js").Guard} parts.guard
   * @param {import("../../base/notices.js").Notices} parts.notices
   * @param {import("./queue.js").Queue} parts.queue
   * @param {(person: number) => void} parts.select
   */
  constructor({ store, history, guard, notices, queue, select }) {
    this._store = store;
    this._history = history;
    this._guard = guard;
    this._notices = notices;
    this._queue = queue;
    this._select = select;
  }

  /** Rows for the table of actions, by the ids of the key table. */
  table() {
    return {
      validate: () => this.validate(),
      validateAll: () => this.validateAll(),
      validateNext: () => this.validate() && this.selectCarried(),
      remove: () => this.remove(),
      nextPerson: () => this._selectNeighbour(1),
      previousPerson: () => this._selectNeighbour(-1),
      nextCarried: () => this.selectCarried(),
    };
  }

  /** @returns {boolean} whether somebody is validated now */
  validate() {
    const person = this._guard.selected();
    if (!person) return false;
    if (person.state === "carried") this._history.run(commands.validate(this._store, [person.person]));
    return true;
  }

  /** @returns {boolean} whether everybody is validated now */
  validateAll() {
    const persons = carriedOf(this._store.people()).map(({ person }) => person);
    if (this._guard.refused()) return false;
    if (persons.length) this._history.run(commands.validate(this._store, persons));
    return true;
  }

  /** @returns {boolean} whether somebody was removed */
  remove() {
    const person = this._guard.selected();
    if (!person) return false;
    this._history.run(commands.remove(this._store, person.person));
    this._notices.say(
      gettext("Person {person} removed – {key} brings it back", { person: person.person, key: keyFor("undo") }),
    );
    return true;
  }

  selectCarried() {
    const next = this._queue.next(this._store.selection);
    if (!next) return this._notices.say(gettext("Nobody is yellow in this frame"));
    this._select(next.person);
  }

  /** @param {1|-1} offset */
  _selectNeighbour(offset) {
    const people = asList(this._store.people());
    if (!people.length)
      return this._notices.say(gettext("Nobody is marked in this frame yet: click on somebody's feet"));
    const index = people.findIndex(({ person }) => person === this._store.selection);
    const from = index < 0 && offset < 0 ? 0 : index;
    this._select(people[(from + offset + people.length) % people.length].person);
  }
}
