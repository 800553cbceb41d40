import { Emitter } from "../base/emitter.js";

/**
 * Which frame is looked at, who is in it, and who is chosen. Frames are known in two orders: worst first, and in
 * time. Emits `frame`, `marks` and `selection` {after}.
 * @typedef {"missed"|"extra"|"swapped"|"matched"} Counted
 * @typedef {Counted|"moved"} Kind somebody moved is matched, but far off
 * @typedef {{person: number, position: number, height: number|null, radius: number|null}} Side of a mark
 * @typedef {{frame: number, truth: number, found: number, moved?: number} & Record<Counted, number>} Line of the table of frames;
 *   swapped people are among the matched
 * @typedef {{distance: number|null, before: number|null}} Told metres, and the number somebody swapped had before
 * @typedef {Told & {kind: "missed", truth: Side, found: null}} Missed
 * @typedef {Told & {kind: "extra", truth: null, found: Side}} Extra
 * @typedef {Told & {kind: "swapped"|"moved"|"matched", truth: Side, found: Side}} Pair
 * @typedef {Missed|Extra|Pair} MarkJSON as the server sends it
 * @typedef {MarkJSON & {key: number, main: Side, shown: Side}} Mark `shown`: the side whose box and number are
 *   shown; `main`: the same, numbered by the mark's key
 * @typedef {{frames: ReadonlySet<number>}} Change never said: nobody moves here
 * @extends {Emitter<{frame: void, marks: void, selection: {after: number|null}, change: Change}>}
 */
export class CompareStore extends Emitter {
  /** @param {Line[]} lines of the table of frames, worst first */
  constructor(lines) {
    super();
    this.lines = lines;
    this.numbers = lines.map(({ frame }) => frame);
    this.inTime = [...this.numbers].sort((one, other) => one - other);
    this.current = this.numbers[0];
    /** @type {number|null} key of a mark */
    this.selection = null;
    /** @type {Map<number, Mark[]>} by frame */
    this._marks = new Map();
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

  /** @param {number} number */
  has(number) {
    return this._marks.has(number);
  }

  /** Who can be clicked on, as the workbench's pointer wants them. */
  people() {
    return new Map(this.marks().map((mark) => [mark.key, mark.main]));
  }

  selected() {
    return this.selection === null ? undefined : this.people().get(this.selection);
  }

  /** @param {number} number @param {MarkJSON[]} marks */
  put(number, marks) {
    this._marks.set(
      number,
      marks.map((mark, index) => prepared(mark, index, this.sideOf(mark))),
    );
    if (number === this.current) this.emit("marks");
  }

  /**
   * The truth where there is one.
   * @param {MarkJSON} mark @returns {Side}
   */
  sideOf(mark) {
    return mark.kind === "extra" ? mark.found : mark.truth;
  }

  /** @param {number} number */
  open(number) {
    if (number === this.current || !this.numbers.includes(number)) return;
    this.current = number;
    this.selection = null;
    this.emit("frame");
  }

  /** @param {number|null} key */
  select(key) {
    if (key === this.selection) return;
    this.selection = key;
    this.emit("selection", { after: key });
  }

  /**
   * The frame `steps` further, worst first or in time; stays at the ends.
   * @param {number} steps @param {number[]} [numbers]
   */
  neighbour(steps, numbers = this.numbers) {
    const place = numbers.indexOf(this.current) + steps;
    return numbers[Math.max(0, Math.min(numbers.length - 1, place))];
  }
}

/**
 * Drawing, picking and zooming take a mark by one of its sides.
 * @param {MarkJSON} mark @param {number} index @param {Side} shown @returns {Mark}
 */
function prepared(mark, index, shown) {
  const key = index + 1;
  return { ...mark, key, shown, main: { ...shown, person: key } };
}
