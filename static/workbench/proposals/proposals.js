/**
 * @typedef {import("../../base/answers.js").Proposed} Proposed
 * @typedef {import("../../base/answers.js").ProposalsAnswer} ProposalsAnswer
 * @typedef {import("../../truth/commands.js").Patch} Patch
 * @typedef {{frame: number, position: number}} Place
 * @typedef {object} Parts
 * @property {import("../../base/api.js").Api} api
 * @property {import("../../truth/scene.js").Scene} scene
 * @property {import("../../truth/store.js").Store} store
 * @property {import("../../truth/history.js").History} history
 */
import { Emitter } from "../../base/emitter.js";
import { gettext, ngettext } from "../../base/messages.js";
import { annotation, CARRIED, VALIDATED } from "../../truth/annotation.js";
import { patch } from "../../truth/commands.js";
import { standing, walking } from "./inheriting.js";
import { openOnes, personsOf } from "./matching.js";

const ORIGIN = "proposed";

/**
 * What programs propose for the frames of the page: which of it is open, accepting and refusing it as steps that
 * can be undone. Nothing of it is in the store before the annotator accepts. Emits `change`.
 * @extends {Emitter<{change: void}>}
 */
export class Proposals extends Emitter {
  /** @param {Parts} parts @param {ProposalsAnswer} answer @param {number} threshold */
  constructor({ api, scene, store, history }, answer, threshold) {
    super();
    this._api = api;
    this._scene = scene;
    this._store = store;
    this._history = history;
    this._threshold = threshold;
    this._frames = new Map(answer.frames.map((frame) => [frame.number, frame.people]));
    /** @type {Map<number, Map<number, Proposed>>} track → frame → the proposal there */
    this._tracks = new Map();
    for (const { number, people } of answer.frames) {
      for (const one of people)
        this._tracks.set(one.track, (this._tracks.get(one.track) ?? new Map()).set(number, one));
    }
    /** @type {WeakMap<Proposed, Proposed>} as it was proposed → as it was moved last; the same one as long as it stays there */
    this._moved = new WeakMap();
    /** @type {Map<number, number>} person by track */
    this._known = new Map();
    for (const one of answer.frames.flatMap(({ people }) => people)) {
      if (one.person !== null) this._known.set(one.track, one.person);
    }
    /** @type {Map<string, Place>} what the server knows to be refused */
    this._kept = places(
      answer.frames.flatMap(({ number, refused }) => refused.map((position) => ({ frame: number, position }))),
    );
    this._refused = new Map(this._kept);
    /** @type {Proposed[]|null} of the open frame, until something changes */
    this._open = null;
    /** @type {Proposed|null} the one that keys are about */
    this.focus = null;
    this._sending = false;
    for (const name of /** @type {const} */ (["change", "frame"])) store.on(name, () => this._changed());
    history.on("change", () => this._readHistory());
    this._readHistory();
  }

  get threshold() {
    return this._threshold;
  }

  set threshold(threshold) {
    this._threshold = threshold;
    this._changed();
  }

  /** Open proposals of the frame on the page, the most doubtful first. @returns {Proposed[]} */
  get open() {
    this._open ??= this.openIn(this._store.current).sort((one, other) => other.doubt - one.doubt);
    return this._open;
  }

  /** @param {number} number of a frame */
  openIn(number) {
    const refused = new Set(
      [...this._refused.values()].flatMap(({ frame, position }) => (frame === number ? [position] : [])),
    );
    const proposed = (this._frames.get(number) ?? []).map((one) => this._settled(number, one));
    return openOnes(proposed, this._store.people(number), refused, this._known, this.metres);
  }

  /**
   * As the frames beside it show the same track: corrected as somebody who stands was corrected there, or between the
   * steps of somebody who walks.
   * @param {number} number @param {Proposed} one
   */
  _settled(number, one) {
    const moved = this._standing(number, one) ?? this._walking(number, one);
    if (this._moved.get(one)?.position !== moved.position) this._moved.set(one, moved);
    return this._moved.get(one) ?? one;
  }

  /** By the nearest frame in which somebody has looked at the person. @param {number} number @param {Proposed} one */
  _standing(number, one) {
    const { numbers } = this._store;
    const index = numbers.indexOf(number);
    /** @param {number} other */
    const away = (other) => Math.abs(numbers.indexOf(other) - index);
    const [nearest] = [...(this._tracks.get(one.track)?.keys() ?? [])]
      .filter((other) => other !== number && this._marked(other, one.track) !== null)
      .sort((first, second) => away(first) - away(second));
    const beside = this._beside(nearest, one.track);
    return beside && standing(one, beside, this._scene);
  }

  /** @param {number} number @param {Proposed} one */
  _walking(number, one) {
    const [earlier, later] = [-1, 1].map((offset) => this._store.neighbour(offset, number));
    if (earlier === undefined || later === undefined || number - earlier !== later - number) return one;
    const [before, after] = [earlier, later].map((other) => this._beside(other, one.track));
    return before && after ? walking(one, before, after, this._scene) : one;
  }

  /** @param {number} number @param {number} track @returns {import("./inheriting.js").Beside|null} */
  _beside(number, track) {
    const proposal = this._tracks.get(track)?.get(number);
    return proposal ? { proposal, marked: this._marked(number, track) } : null;
  }

  /** Where an annotator has validated whoever the track is of. @param {number} number @param {number} track */
  _marked(number, track) {
    const person = this._known.get(track);
    const one = person === undefined ? undefined : this._store.person(person, number);
    return one?.state === VALIDATED ? one.position : null;
  }

  /** Those taken for real. */
  get likely() {
    return this.open.filter(({ score }) => score >= this._threshold);
  }

  /** Those that somebody should look at. */
  get doubtful() {
    return this.open.filter(({ score }) => score < this._threshold);
  }

  /** @param {number} position */
  metres = (position) => this._scene.metres(position);

  /**
   * The number its track has, if somebody gave it one.
   * @param {Proposed} one
   */
  personOf(one) {
    return this._known.get(one.track) ?? null;
  }

  /**
   * Make annotations of them, validated; who was carried over goes where they are proposed.
   * @param {Proposed[]} chosen
   */
  accept(chosen) {
    const label = ngettext("accept {n} proposal", "accept {n} proposals", chosen.length);
    this._take(chosen, VALIDATED, label);
  }

  /**
   * Make yellow people of them, to be looked at one by one.
   * @param {Proposed[]} chosen
   */
  takeUp(chosen) {
    this._take(chosen, CARRIED, ngettext("look at {n} proposal", "look at {n} proposals", chosen.length));
  }

  /**
   * Nobody is there.
   * @param {Proposed} one
   */
  refuse({ position }) {
    const refuses = { frame: this._store.current, position };
    this._history.run({ ...patch(this._store, gettext("refuse a proposal"), []), refuses });
  }

  /**
   * Whom each of them is of, as far as that is known; those who would be somebody new are not in the map.
   * @param {Proposed[]} chosen
   */
  personsOf(chosen) {
    return personsOf(chosen, this._store.people(), this._known, this.metres);
  }

  /**
   * What makes people of them, for a step that does more than that.
   * @param {Proposed[]} chosen @param {import("../../truth/annotation.js").State} state
   */
  edits(chosen, state) {
    const persons = this.personsOf(chosen);
    return chosen.map((one) => {
      const person = persons.get(one) ?? this._store.takePerson();
      if (!this._known.has(one.track)) this._known.set(one.track, person);
      const { position, height, radius } = one;
      const after = annotation({ person, position, state, origin: ORIGIN, height, radius });
      return { frame: this._store.current, person, after };
    });
  }

  /** @param {Proposed[]} chosen @param {import("../../truth/annotation.js").State} state @param {string} label */
  _take(chosen, state, label) {
    const edits = this.edits(chosen, state);
    const select = edits.length === 1 ? edits[0].person : undefined;
    this._history.run(patch(this._store, label, edits, { select }));
  }

  /** @param {Proposed|null} one */
  look(one) {
    if (one === this.focus) return;
    this.focus = one;
    this.emit("change");
  }

  /**
   * Whom the annotator removed, though a program had proposed them, is refused as well. Undone steps refuse nothing.
   */
  _readHistory() {
    const { done, undone } = this._history.dump();
    const taken = places(undone.flatMap(refusalsOf));
    const kept = [...this._kept].filter(([key]) => !taken.has(key));
    this._refused = new Map([...kept, ...places(done.flatMap(refusalsOf))]);
    this._changed();
    this._send();
  }

  _changed() {
    this._open = null;
    if (this.focus && !this.open.includes(this.focus)) this.focus = null;
    this.emit("change");
  }

  /** What the server does not know; without an answer it is told with the next step. */
  async _send() {
    if (this._sending || !this._scene.editable) return;
    this._sending = true;
    try {
      for (let next = this._untold(); next; next = this._untold()) {
        const { key, place, refused } = next;
        await this._api.ask("POST", "refusals/", { ...place, refused });
        if (refused) this._kept.set(key, place);
        else this._kept.delete(key);
      }
    } catch (error) {
      console.warn("a refusal was not kept yet", error);
    } finally {
      this._sending = false;
    }
  }

  /** @returns {{key: string, place: Place, refused: boolean}|null} */
  _untold() {
    for (const [key, place] of this._refused) if (!this._kept.has(key)) return { key, place, refused: true };
    for (const [key, place] of this._kept) if (!this._refused.has(key)) return { key, place, refused: false };
    return null;
  }
}

/** @param {Patch} step @returns {Place[]} */
function refusalsOf({ refuses, edits }) {
  const removed = edits.flatMap((edit) =>
    !edit.flags && edit.before?.origin === ORIGIN && !edit.after
      ? [{ frame: edit.frame, position: edit.before.position }]
      : [],
  );
  return refuses ? [refuses, ...removed] : removed;
}

/** @param {Place[]} list @returns {Map<string, Place>} */
function places(list) {
  return new Map(list.map((place) => [`${place.frame} ${place.position}`, place]));
}
