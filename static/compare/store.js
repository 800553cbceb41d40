import { Emitter } from "../base/emitter.js";

/**
 * Which frame is looked at, who is in it, and who is chosen. Frames are known in two orders: worst first, and in
 * time. Emits `frame`, `marks` and `selection` {after}.
 */
export class CompareStore extends Emitter {
  /** @param {object[]} lines of the table of frames, worst first */
  constructor(lines) {
    super();
    this.lines = lines;
    this.numbers = lines.map(({ frame }) => frame);
    this.inTime = [...this.numbers].sort((one, other) => one - other);
    this.current = this.numbers[0];
    this.selection = null;
    this._marks = new Map(); // frame → marks
  }

  get line() {
    return this.lines[this.rank];
  }

  /** Place among the frames, worst first, from 0. */
  get rank() {
    return this.numbers.indexOf(this.current);
  }

  marks() {
    return this._marks.get(this.current) ?? [];
  }

  has(number) {
    return this._marks.has(number);
  }

  /** Who can be clicked on, as the workbench's pointer wants them. */
  people() {
    return new Map(this.marks().map((mark) => [mark.key, mark.main]));
  }

  selected() {
    return this.people().get(this.selection);
  }

  put(number, marks) {
    this._marks.set(number, marks.map(prepared));
    if (number === this.current) this.emit("marks", {});
  }

  open(number) {
    if (number === this.current || !this.numbers.includes(number)) return;
    this.current = number;
    this.selection = null;
    this.emit("frame", {});
  }

  select(key) {
    if (key === this.selection) return;
    this.selection = key;
    this.emit("selection", { after: key });
  }

  /** The frame `steps` further, worst first or in time; stays at the ends. */
  neighbour(steps, numbers = this.numbers) {
    const place = numbers.indexOf(this.current) + steps;
    return numbers[Math.max(0, Math.min(numbers.length - 1, place))];
  }
}

/** Drawing, picking and zooming take a mark by one of its sides: the truth where there is one. */
function prepared(mark, index) {
  const key = index + 1;
  const main = { ...(mark.truth ?? mark.found), person: key };
  return { ...mark, key, main };
}
