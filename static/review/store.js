import { CompareStore } from "../compare/store.js";

/**
 * Where in the batch the reviewer is: CompareStore with every frame's marks at hand, and a way through all
 * differences, worst first, over the borders of frames. Emits `seen` as well, when a difference was looked at.
 * @typedef {import("../compare/store.js").Line} Line
 * @typedef {import("../compare/store.js").MarkJSON} MarkJSON
 * @typedef {Line & {moved: number, differences: number, compared: boolean, marks: MarkJSON[]}} FrameJSON
 * @typedef {{name: string, about: string}} Reference
 * @typedef {{reference: string|null, references: Reference[], frames: FrameJSON[], worst_first: [number, number][]}}
 *   Answer of the server
 */
export class DeskStore extends CompareStore {
  /** @param {Answer} answer */
  constructor({ frames, worst_first: worst }) {
    super(frames.map((frame) => ({ ...frame, matched: frame.matched + frame.swapped })));
    this.frames = frames;
    this.worst = worst;
    /** Place among the differences, from 0; -1: none was gone to yet. */
    this.place = -1;
    /** @type {Set<number>} places */
    this.seen = new Set();
    for (const { frame, marks } of frames) this.put(frame, marks);
  }

  /**
   * The worker's side, which is what is judged.
   * @param {MarkJSON} mark @override
   */
  sideOf(mark) {
    return mark.found ?? mark.truth;
  }

  /** A frame as people count them, from 1. @param {number} number */
  ordinal(number) {
    return this.inTime.indexOf(number) + 1;
  }

  /** How many differences were not looked at yet. */
  get unseen() {
    return this.worst.length - this.seen.size;
  }

  /** The mark that is chosen. */
  get chosen() {
    return this.marks().find(({ key }) => key === this.selection);
  }

  /**
   * The next difference or the one before; after the last comes the first. False where there is none.
   * @param {number} by
   */
  step(by) {
    if (!this.worst.length) return false;
    this.place = (this.place + by + this.worst.length) % this.worst.length;
    if (by < 0 && this.seen.size === 0) this.place = this.worst.length - 1;
    this.seen.add(this.place);
    const [frame, mark] = this.worst[this.place];
    this.open(frame);
    this.select(mark + 1);
    return true;
  }

  /**
   * @param {number|null} key
   * @override
   */
  select(key) {
    const at = this.worst.findIndex(([frame, mark]) => frame === this.current && mark + 1 === key);
    if (at >= 0) {
      this.place = at;
      this.seen.add(at);
    }
    super.select(key);
  }
}
