import { Emitter } from "../base/emitter.js";

/**
 * The truth: which person stands at which position in which frame, what is selected, which frame is open.
 * Knows no pixels, no page, no server.
 *
 * Events: `change` {frames, persons, source} — `source` is "edit" (to be saved), "server" or "journal";
 * `selection` {before, after}; `frame` {before, after}.
 */
export class Store extends Emitter {
  /** @param {number[]} numbers frame numbers in order @param {number} nextPerson smallest number never used */
  constructor(numbers, nextPerson) {
    super();
    this.numbers = numbers;
    this.current = numbers[0];
    this.selection = null;
    this._nextPerson = nextPerson;
    this._frames = new Map(numbers.map((number) => [number, emptyFrame(number)]));
  }

  frame(number = this.current) {
    return this._frames.get(number);
  }

  people(number = this.current) {
    return this._frames.get(number).people;
  }

  person(person, number = this.current) {
    return this._frames.get(number).people.get(person);
  }

  selected() {
    return this.selection === null ? undefined : this.person(this.selection);
  }

  /** Who stands exactly there, apart from `except`. */
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

  /** Whether no save and no edit of this layer has given the number to anybody. */
  isUnused(person) {
    return person >= this._nextPerson;
  }

  reservePerson(person) {
    this._nextPerson = Math.max(this._nextPerson, person + 1);
  }

  /** Replace a whole frame: what the server or the journal says. */
  install(number, { people, done = false, nobody = false }, source) {
    const frame = this._frames.get(number);
    const persons = new Set([...frame.people.keys(), ...people.keys()]);
    for (const person of people.keys()) this.reservePerson(person);
    Object.assign(frame, { people: new Map(people), done, nobody, loaded: true });
    this._afterChange(new Set([number]), persons, source);
  }

  /** Carry out edits: {frame, person, after} or {frame, flags: {after: {done, nobody}}}. */
  apply(edits, source = "edit") {
    const frames = new Set();
    const persons = new Set();
    for (const edit of edits) {
      const frame = this._frames.get(edit.frame);
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

  select(person) {
    const before = this.selection;
    this.selection = person !== null && this.person(person) ? person : null;
    if (this.selection !== before) this.emit("selection", { before, after: this.selection });
  }

  open(number) {
    if (number === this.current || !this._frames.has(number)) return;
    const before = this.current;
    this.current = number;
    this.emit("frame", { before, after: number });
    if (this.selection !== null && !this.person(this.selection)) this.select(null);
  }

  neighbour(offset, number = this.current) {
    return this.numbers[this.numbers.indexOf(number) + offset];
  }

  _afterChange(frames, persons, source) {
    this.emit("change", { frames, persons, source });
    if (this.selection !== null && !this.person(this.selection)) this.select(null);
  }
}

function emptyFrame(number) {
  return { number, people: new Map(), done: false, nobody: false, loaded: false };
}
