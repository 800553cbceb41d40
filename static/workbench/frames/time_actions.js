import { ask } from "../../base/dialogs.js";
import { fetchedDialog } from "../../base/lazy.js";
import { gettext, ngettext } from "../../base/messages.js";
import { loadMissing } from "../../saving/load_missing.js";
import { CARRIED, changed } from "../../truth/annotation.js";
import * as commands from "../../truth/commands.js";
import { freePosition, predictPeople } from "../../truth/propagation.js";
import { sourcesOn, withFreeNumbers } from "../../truth/sources.js";
import { nextTask } from "../../truth/todo.js";
import { keyFor } from "../keys/keys.js";

/**
 * @typedef {import("../../truth/annotation.js").Annotation} Annotation
 * @typedef {import("../../truth/sources.js").FrameSource} Source
 * @typedef {-1|1} Direction to the frame before, or after
 * @typedef {import("../settings.js").WhosePaths} WhosePaths
 */

/** @type {WhosePaths[]} */
const PATHS = ["none", "selected", "all"];

/** What an annotator does across frames: carry, copy, fill, look through, find what is left. */
export class TimeActions {
  /**
   * @param {object} parts
   * @param {import("../../truth/scene.js").Scene} parts.scene
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {import("../../truth/history.js").History} parts.history
   * @param {import("../../saving/loader.js").Loader} parts.loader
   * @param {import("../settings.js").Settings} parts.settings
   * @param {import("../../views/panes.js").Panes} parts.panes
   * @param {import("../../base/notices.js").Notices} parts.notices
   * @param {import("../placing/guard.js").Guard} parts.guard
   * @param {import("./navigation.js").Navigation} parts.navigation
   * @param {import("./playback.js").Playback} parts.playback
   */
  constructor({ scene, store, history, loader, settings, panes, notices, guard, navigation, playback }) {
    this.scene = scene;
    this.store = store;
    this.history = history;
    this.loader = loader;
    this.settings = settings;
    this.panes = panes;
    this.notices = notices;
    this.guard = guard;
    this.navigation = navigation;
    this.playback = playback;
    /** @type {() => Promise<typeof import("./fill_dialog.js")|null>} */
    this._dialog = fetchedDialog(notices, import.meta.resolve("./fill_dialog.js"));
    /** @type {Set<number>} */
    this._asked = new Set(); // people in one frame only, shown once
  }

  /**
   * Rows for the table of actions, by the ids of the key table.
   * @returns {import("../actions.js").ActionTable}
   */
  table() {
    return {
      bring: () => this.bring(-1),
      bringNext: () => this.bring(1),
      copyPrevious: () => this.copy(-1),
      copyNext: () => this.copy(1),
      fill: () => this.fill(),
      play: () => this.playback.toggle(),
      lookNext: () => this.look(1),
      lookPrevious: () => this.look(-1),
      nextTask: () => this.goToNextTask(),
      pathsInViews: () => this.cyclePaths("pathsInViews"),
      pathsOnMap: () => this.cyclePaths("pathsOnMap"),
      filmstrip: () => this.settings.set("filmstrip", !this.settings.get("filmstrip")),
    };
  }

  /**
   * Everybody of the frame beside this one who is missing here, moved on the way he walked.
   * @param {Direction} direction
   */
  async bring(direction) {
    if (this.guard.refused()) return;
    const sources = await this._sources(direction);
    if (!sources?.length) return sources && this._sayNobody(direction);
    const { store, scene } = this;
    const missing = predictPeople(scene.grid, scene.seconds(store.current), sources, {
      except: store.people(),
      origin: "copied",
    });
    if (!missing.length) return this.notices.say(gettext("Everybody of that frame is here already"));
    this.history.run(
      commands.bring(store, store.current, sources[0].outside ? withFreeNumbers(store, missing) : missing),
    );
    this.notices.say(ngettext("{n} person loaded", "{n} people loaded", missing.length));
  }

  /**
   * One person exactly where he stands in the frame beside this one: the selected one, or whom one chooses.
   * @param {Direction} direction
   */
  async copy(direction) {
    if (this.guard.refused()) return;
    const sources = await this._sources(direction);
    if (!sources?.length) return sources && this._sayNobody(direction);
    const [source] = sources;
    const person = this._whomToCopy(source) ?? (await this._choose(source));
    if (person === "all") return this._copyAll(source);
    const there = person === null ? undefined : source.people.get(person);
    if (person === null || !there) return;
    const after = this._copied(there);
    const stranger = source.outside && !this.store.person(person); // whose number may mean somebody else here
    this.history.run(commands.copy(this.store, stranger ? withFreeNumbers(this.store, [after])[0] : after));
  }

  async fill() {
    if (this.guard.refused()) return;
    const dialog = await this._dialog();
    if (!dialog || !(await loadMissing(this, this._between()))) return;
    const { store, scene, panes } = this;
    const edits = await dialog.chooseFill(
      store,
      scene,
      panes.options.mapColours,
      store.selection ?? this.navigation.held,
    );
    if (edits === null) return;
    if (!edits.length)
      return this.notices.say(gettext("Nothing to fill: validate a person in two frames, with frames between them"));
    this.history.run(commands.fill(store, edits));
    this.notices.say(ngettext("{n} box filled in", "{n} boxes filled in", edits.length));
  }

  /** @param {number} offset */
  look(offset) {
    const number = this.store.neighbour(offset);
    if (number !== undefined) return this.navigation.look(number);
    this.notices.say(offset > 0 ? gettext("This is the last frame") : gettext("This is the first frame"));
  }

  async goToNextTask() {
    if (!(await loadMissing(this, this.store.numbers))) return;
    const task = nextTask(this.store, this.navigation.judging, this._asked);
    if (!task) return this.notices.say(gettext("Nothing is left to do here"));
    if (task.number !== this.store.current) await this.navigation.jump(task.number);
    if (task.number !== this.store.current) return; // it could not be loaded
    if (task.person !== null) this.store.select(task.person);
    if (task.kind === "single") {
      if (task.person !== null) this._asked.add(task.person);
      this.notices.say(
        gettext("Person {person} is in this frame only – {key} fills in the other frames", {
          person: task.person,
          key: keyFor("fill"),
        }),
      );
    } else if (task.left === "empty") this.notices.say(gettext("Nobody is marked in this frame yet"));
    else if (task.left === "open")
      this.notices.say(gettext("Everybody is validated – {key} says the frame is done", { key: keyFor("nextFrame") }));
  }

  /** @param {"pathsInViews"|"pathsOnMap"} name */
  cyclePaths(name) {
    const next = PATHS[(PATHS.indexOf(this.settings.get(name)) + 1) % PATHS.length];
    this.settings.set(name, next);
    this.notices.say(
      {
        none: gettext("Paths: none"),
        selected: gettext("Paths: of the selected person"),
        all: gettext("Paths: of everybody"),
      }[next],
    );
  }

  /**
   * Null when they could not be loaded.
   * @param {Direction} direction
   */
  async _sources(direction) {
    const number = this.store.neighbour(direction);
    if (number !== undefined && !(await loadMissing(this, [number]))) return null;
    return sourcesOn(this.store, this.scene, this.store.current, direction);
  }

  /** @param {Source} source */
  _whomToCopy({ people }) {
    const person = this.store.selection ?? this.navigation.held;
    return person !== null && people.has(person) ? person : null;
  }

  /** @param {Source} source @returns {Promise<number|"all"|null>} */
  async _choose({ number, people }) {
    const missing = [...people.keys()].filter((person) => !this.store.person(person));
    if (!missing.length) {
      this.notices.say(gettext("Everybody of that frame is here already"));
      return null;
    }
    const answer = await ask({
      title: gettext("Whom to copy from frame {place}?", { place: this._placeOf(number) }),
      body: gettext("People of that frame who are missing here:"),
      buttons: [
        ...missing.map((person) => ({ id: String(person), label: String(person) })),
        { id: "all", label: gettext("All of them"), main: true },
      ],
    });
    return answer === null || answer === "all" ? answer : Number(answer);
  }

  /** @param {Source} source */
  _copyAll(source) {
    const { store } = this;
    const missing = [...source.people.values()].filter(({ person }) => !store.person(person));
    const taken = new Set([...store.people().values()].map(({ position }) => position));
    const copies = missing.map((one) => {
      const after = this._copied(one, taken);
      taken.add(after.position);
      return after;
    });
    this.history.run(commands.bring(store, store.current, source.outside ? withFreeNumbers(store, copies) : copies));
  }

  /** @param {Annotation} one @param {Set<number>} [taken] @returns {Annotation} */
  _copied(one, taken = this._takenBeside(one.person)) {
    const position = freePosition(this.scene.grid, this.scene.metres(one.position), taken);
    return changed(one, { position, state: CARRIED, origin: "copied" });
  }

  /** @param {number} except */
  _takenBeside(except) {
    const others = [...this.store.people().values()].filter(({ person }) => person !== except);
    return new Set(others.map(({ position }) => position));
  }

  /** Of a long layer only pieces are there; between the first and the last one nothing may be missing. */
  _between() {
    const { numbers } = this.store;
    const loaded = numbers.map((number) => this.store.frame(number).loaded);
    return numbers.slice(loaded.indexOf(true), loaded.lastIndexOf(true) + 1);
  }

  /** @param {number} number */
  _placeOf(number) {
    const index = this.store.numbers.indexOf(number);
    return index < 0 ? number : index + 1;
  }

  /** @param {Direction} direction */
  _sayNobody(direction) {
    this.notices.say(
      direction < 0 ? gettext("Nobody is marked before this frame") : gettext("Nobody is marked after this frame"),
    );
  }
}
