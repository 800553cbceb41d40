import { Emitter } from "../base/emitter.js";

/**
 * The truth: which person stands at which position in which frame, what is selected, which frame is open.
 * Knows no pixels, no page, no server.
 *
 * Events: `change` {frames, persons, source} — `source` is "edit" (to be saved), "server" or "journal";
 * `selection` {before, after}; `frame` {before, after}.
 * @typedef {import("./annotation.js").Annotation} Annotation
 * @typedef {import("./annotation.js").People} People
 * @typedef {{done: boolean, nobody: boolean}} Flags what the annotator says about a whole frame
 * @typedef {{number: number, people: People, loaded: boolean} & Flags} Frame
 * @typedef {{frame: number, person: number, after: Annotation|null, before?: Annotation|null, flags?: undefined}} PersonEdit
 * @typedef {{frame: number, flags: {before: Flags, after: Flags}, person?: undefined, before?: undefined, after?: undefined}} FlagEdit
 * @typedef {PersonEdit|FlagEdit} Edit
 * @typedef {"edit"|"server"|"journal"} Source
 * @typedef {{frames: Set<number>, persons: Set<number>, source: Source}} Change
 * @typedef {object} StoreEvents
 * @property {Change} change
 * @property {{before: number|null, after: number|null}} selection
 * @property {{before: number, after: number}} frame
 * @extends {Emitter<StoreEvents>}
 */
export class Store extends Emitter {
  /** @param {number[]} numbers frame numbers in order @param {number} nextPerson smallest number never used */
  constructor(numbers, nextPerson) {
    super();
    this.numbers = numbers;
    this.current = numbers[0];
    /** @type {number|null} */
    this.selection = null;
    this._nextPerson = nextPerson;
    this._frames = new Map(numbers.map((number) => [number, emptyFrame(number)]));
  }

  /** @param {number} [number] one of the frames */
  frame(number = this.current) {
    return /** @type {Frame} */ (this._frames.get(number));
  }

  /** @param {number} [number] */
  people(number = this.current) {
    return this.frame(number).people;
  }

  /** @param {number} person @param {number} [number] */
  person(person, number = this.current) {
    return this.frame(number).people.get(person);
  }

  /** @param {number} person who is marked there; TypeError otherwise @param {number} [number] @returns {Annotation} */
  marked(person, number = this.current) {
    const found = this.person(person, number);
    if (!found) throw new TypeError(`person ${person} is not in frame ${number}`);
    return found;
  }

  selected() {
    return this.selection === null ? undefined : this.person(this.selection);
  }

  /**
   * Who stands exactly there, apart from `except`.
   * @param {number} position @param {number|null} [except] @param {number} [number]
   */
  occupant(position, except = null, number = this.current) {
    for (const one of this.people(number).values()) {
      if (one.position === position && one.person !== except) return one;
    }
    return null;
  }

  /** The next person number nobody ever had in this layer. */
  get nextPerson() {
    return this._nextPerson;
  }

  /** A person number nobody ever had in this layer, given away. */
  takePerson() {
    return this._nextPerson++;
  }

  /**
   * Whether no save and no edit of this layer has given the number to anybody.
   * @param {number} person
   */
  isUnused(person) {
    return person >= this._nextPerson;
  }

  /** @param {number} person */
  reservePerson(person) {
    this._nextPerson = Math.max(this._nextPerson, person + 1);
  }

  /**
   * Replace a whole frame: what the server or the journal says.
   * @param {number} number @param {{people: People} & Partial<Flags>} frame @param {Source} source
   */
  install(number, { people, done = false, nobody = false }, source) {
    const frame = this.frame(number);
    const persons = new Set([...frame.people.keys(), ...people.keys()]);
    for (const person of people.keys()) this.reservePerson(person);
    Object.assign(frame, { people: new Map(people), done, nobody, loaded: true });
    this._afterChange(new Set([number]), persons, source);
  }

  /**
   * Carry out edits: {frame, person, after} or {frame, flags: {after: {done, nobody}}}.
   * @param {Edit[]} edits @param {Source} [source]
   */
  apply(edits, source = "edit") {
    /** @type {Set<number>} */
    const frames = new Set();
    /** @type {Set<number>} */
    const persons = new Set();
    for (const edit of edits) {
      const frame = this.frame(edit.frame);
      frames.add(edit.frame);
      if (edit.flags) Object.assign(frame, edit.flags.after);
      else {
        persons.add(edit.person);
        if (edit.after) {
          this.reservePerson(edit.person);
          frame.people.set(edit.person, edit.after);
        } else frame.people.delete(edit.person);
      }
    }
    if (frames.size) this._afterChange(frames, persons, source);
  }

  /** @param {number|null} person */
  select(person) {
    const before = this.selection;
    this.selection = person !== null && this.person(person) ? person : null;
    if (this.selection !== before) this.emit("selection", { before, after: this.selection });
  }

  /** @param {number} number */
  open(number) {
    if (number === this.current || !this._frames.has(number)) return;
    const before = this.current;
    this.current = number;
    this.emit("frame", { before, after: number });
    if (this.selection !== null && !this.person(this.selection)) this.select(null);
  }

  /**
   * @param {number} offset @param {number} [number] @returns {number|undefined} none beyond the first and the last
   */
  neighbour(offset, number = this.current) {
    return this.numbers[this.numbers.indexOf(number) + offset];
  }

  /** @param {Set<number>} frames @param {Set<number>} persons @param {Source} source */
  _afterChange(frames, persons, source) {
    this.emit("change", { frames, persons, source });
    if (this.selection !== null && !this.person(this.selection)) this.select(null);
  }
}

/** @param {number} number @returns {Frame} */
function emptyFrame(number) {
  return { number, people: new Map(), done: false, nobody: false, loaded: false };
}
