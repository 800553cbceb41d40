import { fetched } from "../../base/lazy.js";
import { gettext } from "../../base/messages.js";
import { carriedOf } from "../../truth/annotation.js";
import { keyFor } from "../keys/keys.js";

/**
 * Going round the yellow people one by one, close up: Enter for who stands right, one right click on the feet for
 * who does not, and the views show the next one. After the last one they show everything again, for people
 * without a box; whoever is placed then is shown close up, too.
 * @typedef {typeof import("./whois.js")} WhoIsPart
 */
export class OneByOne {
  /**
   * @param {object} parts
   * @param {import("../../truth/scene.js").Scene} parts.scene
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {import("../../views/images.js").Images} parts.images
   * @param {import("../../views/panes.js").Panes} parts.panes
   * @param {import("../../base/notices.js").Notices} parts.notices
   * @param {import("../frames/navigation.js").Navigation} parts.navigation
   * @param {import("./queue.js").Queue} parts.queue
   * @param {import("../placing/dragging.js").Dragging} parts.dragging
   * @param {import("../placing/heads.js").Heads} parts.heads
   * @param {import("../annotating_intents.js").AnnotatingIntents} parts.intents
   * @param {import("./people_actions.js").PeopleActions} parts.people
   * @param {() => void} parts.otherwise what Escape does when not one by one
   */
  constructor({
    scene,
    store,
    images,
    panes,
    notices,
    navigation,
    queue,
    dragging,
    heads,
    intents,
    people,
    otherwise,
  }) {
    this._store = store;
    this._panes = panes;
    this._notices = notices;
    this._navigation = navigation;
    this._queue = queue;
    this._dragging = dragging;
    this._heads = heads;
    this._people = people;
    this._otherwise = otherwise;
    /** @type {number[]} people gone past in this frame, newest last */
    this._passed = [];
    store.on("frame", () => (this._passed = []));
    store.on("selection", ({ after }) => this.on && after !== null && !panes.zoomed && panes.zoom(true));
    intents.on("moved", () => this.on && this._advance());
    /** @param {WhoIsPart} part */
    const make = ({ WhoIs }) => new WhoIs({ scene, store, images, panes });
    this._showWho = fetched(notices, import.meta.resolve("./whois.js"), make);
  }

  /** @returns {boolean} */
  get on() {
    return this._panes.closeUp;
  }

  /** Rows for the table of actions; those that exist already go on to the next person, too. */
  table() {
    const people = this._people;
    return {
      round: () => (this.on ? this._leave() : this._enter()),
      roundBack: () => this._back(),
      validateNext: () => people.validate() && (this.on ? this._advance() : people.selectCarried()),
      validateAll: () => people.validateAll() && this.on && this._advance(),
      remove: () => people.remove() && this.on && this._advance(),
      nextFrame: () => this._nextFrame(),
      escape: () => (this.on && !this._dragging.active && !this._heads.active ? this._leave() : this._otherwise()),
    };
  }

  _enter() {
    this._panes.closeUp = true;
    this._showWho();
    if (this._store.selection === null) this._selectNext();
    this._panes.zoom(true);
    if (this._store.selection === null) this._sayAllSeen();
  }

  _leave() {
    this._panes.closeUp = false;
    this._panes.zoom(false);
  }

  _advance() {
    if (this._store.selection !== null) this._passed.push(this._store.selection);
    if (!this._selectNext()) this._showEverything();
  }

  /** @returns {boolean} whether somebody is yellow */
  _selectNext() {
    const next = this._queue.next(this._store.selection ?? this._passed.at(-1) ?? null);
    if (next) this._store.select(next.person);
    return next !== undefined;
  }

  _showEverything() {
    this._store.select(null);
    this._panes.zoom(false);
    this._sayAllSeen();
  }

  _sayAllSeen() {
    this._notices.say(
      gettext("Nobody is yellow. Is somebody without a box? Click between their feet. {on} goes on, {back} goes back", {
        on: keyFor("nextFrame"),
        back: keyFor("roundBack"),
      }),
    );
  }

  /** The one before, validated as they are: for a click that was not good enough. */
  _back() {
    let person = this._passed.pop();
    while (person !== undefined && !this._store.person(person)) person = this._passed.pop();
    if (person === undefined) return this._notices.say(gettext("You have not looked at anybody in this frame yet"));
    this._store.select(person);
    this._panes.zoom(true);
  }

  async _nextFrame() {
    const before = this._store.current;
    await this._navigation.next();
    if (!this.on || this._store.current === before) return;
    if (!carriedOf(this._store.people()).length) return this._showEverything();
    this._store.select(null); // from the first one on, whoever was looked at last
    this._selectNext();
  }
}
