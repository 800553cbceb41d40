import { ask } from "../../base/dialogs.js";
import { failureWords } from "../../base/failure_words.js";
import { gettext, ngettext } from "../../base/messages.js";
import { carriedOf } from "../../truth/annotation.js";
import * as commands from "../../truth/commands.js";
import { between, isFilled } from "../../truth/keyframes.js";
import { same } from "../../truth/merge.js";
import { isGuess, predictPeople } from "../../truth/propagation.js";
import { nearestSide, withFreeNumbers } from "../../truth/sources.js";

const AT_ONCE = 96; // light pictures kept at hand: a batch of ten frames with up to nine views
const PLAYING = 8; // frames fetched ahead of a running film

/** @typedef {import("../../truth/annotation.js").Annotation} Annotation */

/**
 * Going through the frames. Leaving a frame forwards says it is done; a frame nobody has been to starts with
 * the people of the frames beside it, moved on the way they walked, yellow.
 */
export class Navigation {
  /**
   * @param {object} parts
   * @param {import("../../truth/scene.js").Scene} parts.scene
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {import("../../truth/history.js").History} parts.history
   * @param {import("../../saving/saver.js").Saver} parts.saver
   * @param {import("../../views/images.js").Images} parts.images
   * @param {import("../../saving/loader.js").Loader} parts.loader
   * @param {import("../../base/notices.js").Notices} parts.notices
   * @param {() => Promise<unknown>} parts.finish
   */
  constructor({ scene, store, history, saver, images, loader, notices, finish }) {
    this.scene = scene;
    this.store = store;
    this.history = history;
    this.saver = saver;
    this.images = images;
    this.loader = loader;
    this.notices = notices;
    this._finish = finish;
    this._busy = false;
    /** @type {number|null} */
    this._looking = null; // the frame one scrubs to, while it is loaded
    /** @type {number|null} */
    this._held = null; // who was selected before a frame without that person
    this._ahead = 0;
    this._around = 0;
    /** @type {Map<number, Set<number>>} frame → people carried into it on this visit */
    this._brought = new Map();
    store.on("frame", () => this._prefetch());
    this._prefetch();
  }

  /** Whom one worked on before coming to a frame without that person; null otherwise. */
  get held() {
    return this.store.selection === null ? this._held : null;
  }

  get judging() {
    return this.scene.mode === "assignment" && this.saver.readOnly === null;
  }

  next() {
    return this._alone(async () => {
      if (this.judging && !(await this._leaveForward())) return;
      const next = this.store.neighbour(1);
      if (next !== undefined) await this.open(next);
      else if (this.scene.mode === "assignment") await this._finish();
      else this.notices.say(gettext("This is the last frame"));
    });
  }

  previous() {
    return this._alone(async () => {
      const previous = this.store.neighbour(-1);
      if (previous === undefined) return this.notices.say(gettext("This is the first frame"));
      await this.open(previous);
    });
  }

  /** @param {number} number */
  jump(number) {
    return this._alone(() => this.open(number));
  }

  /**
   * Only look: nobody is carried over, nothing is said to be done. The newest wish wins.
   * @returns {Promise<boolean>} false: said that the frame could not be loaded
   * @param {number} number
   */
  async look(number) {
    this._looking = number;
    try {
      await this.loader.load(number, false);
    } catch (error) {
      if (this._looking === number) this._sayNotLoaded(error);
      return this._looking !== number;
    }
    if (this._looking === number) this._show(number);
    return true;
  }

  /**
   * While playing, more of what comes is fetched.
   * @param {boolean} on
   */
  lookAhead(on) {
    this._ahead = on ? PLAYING : 0;
    this._prefetch();
  }

  /**
   * Frames on both sides that somebody wants to see.
   * @param {number} reach
   */
  lookAround(reach) {
    this._around = reach;
    this._prefetch();
  }

  /** Take the server's newest state of this frame; edits not yet saved are saved first. */
  reload() {
    return this._alone(async () => {
      const number = this.store.current;
      if (!(await this.saver.flush()))
        return this.notices.say(gettext("Not loaded: there are edits still to be saved"));
      await this.loader.load(number, true);
      this.notices.say(gettext("Frame loaded from the server"));
    });
  }

  /**
   * People for a frame of a batch that nobody has worked in yet: on the line between two keyframes, or moved on
   * from the nearer side. Guesses of an earlier visit are made anew: more may be known by now.
   * @param {number} number
   */
  carryInto(number) {
    const { store, scene } = this;
    if (!this._isFresh(number)) return;
    const here = store.people(number);
    const sources = nearestSide(store, scene, number);
    if (!sources.length || (here.size && sources[0].outside)) return;
    const except = new Map([...here].filter(([person]) => !sources[0].people.has(person)));
    const expected = predictPeople(scene.grid, scene.seconds(number), sources, { except });
    const brought = sources[0].outside
      ? withFreeNumbers(store, expected)
      : expected
          .map((one) => between(store, scene, one.person, number) ?? one)
          .filter((one) => this._isNews(number, one));
    this._brought.set(number, new Set([...(this._brought.get(number) ?? []), ...expected.map(({ person }) => person)]));
    if (brought.length) this.history.run(commands.bring(store, number, brought));
  }

  /**
   * Whether nobody in a frame was looked at yet. Empty and saved, or emptied: somebody has been there.
   * @param {number} number
   */
  _isFresh(number) {
    const { people, nobody, done } = this.store.frame(number);
    if (!this.judging || nobody || done) return false;
    if (people.size === 0) return this.saver.revision(number) === 0 && !this._brought.has(number);
    return [...people.values()].every(isGuess);
  }

  /**
   * Who was brought before and is not here any more was removed; who would stand where he stands is no news.
   * @param {number} number @param {Annotation} one
   */
  _isNews(number, one) {
    const here = this.store.people(number);
    if (here.has(one.person)) return !same(here.get(one.person), one);
    const brought = this._brought.get(number);
    if (brought) return !brought.has(one.person);
    return [...here.values()].every(isFilled); // filled in from elsewhere: the others were never brought
  }

  /**
   * Show a frame; whoever calls it has asked what has to be asked.
   * @param {number} number
   */
  async open(number) {
    await this.loader.load(number, false);
    this._looking = null;
    this._show(number);
    this.carryInto(number);
    this._selectAgain();
  }

  /** @param {number} number */
  _show(number) {
    this._held = this.store.selection ?? this._held;
    this.store.open(number);
    this._selectAgain();
  }

  /** Whom one works on stays selected, also after frames without that person. */
  _selectAgain() {
    if (this.store.selection === null && this._held !== null) this.store.select(this._held);
    if (this.store.selection !== null) this._held = null;
  }

  /** @returns {Promise<boolean>} whether the frame may be left */
  async _leaveForward() {
    const number = this.store.current;
    const waiting = carriedOf(this.store.people());
    if (waiting.length) {
      const answer = await this._askAboutCarried(waiting);
      if (answer === "skip") return true;
      if (answer !== "validate") return false;
      this.history.run(
        commands.validate(
          this.store,
          waiting.map(({ person }) => person),
        ),
      );
    }
    const empty = this.store.people().size === 0;
    if (empty && !this.store.frame().nobody && !(await this._askNobody())) return false;
    const { done } = this.store.frame();
    if (!done) this.history.run(commands.finishFrame(this.store, number, empty));
    return true;
  }

  /** @param {Annotation[]} waiting */
  async _askAboutCarried(waiting) {
    const answer = await ask({
      title: ngettext("{n} person is still yellow", "{n} people are still yellow", waiting.length),
      body: gettext("They stand where the frames beside this one suggest. Have you looked at all of them?"),
      buttons: [
        { id: "look", label: gettext("Look at the first one"), main: true },
        { id: "validate", label: gettext("All are right: validate and go on") },
        { id: "skip", label: gettext("Go on, come back later") },
      ],
    });
    if (answer === "look") this.store.select(waiting[0].person);
    return answer;
  }

  async _askNobody() {
    const answer = await ask({
      title: gettext("Nobody is marked in this frame"),
      body: gettext("Is the ground area really empty in all views?"),
      buttons: [
        { id: "stay", label: gettext("No, stay here"), main: true },
        { id: "nobody", label: gettext("Yes, nobody is there") },
      ],
    });
    return answer === "nobody";
  }

  /** Of a batch all pictures, nearest first: they will be needed. Of a long layer those one can come to next. */
  _prefetch() {
    const { numbers, current } = this.store;
    const index = numbers.indexOf(current);
    const whole = numbers.length * this.scene.cameras.length <= AT_ONCE;
    const [ahead, behind] = whole
      ? [numbers.length, numbers.length]
      : [Math.max(2, this._ahead, this._around), Math.max(1, this._around)];
    /** @param {number} one */
    const distance = (one) => (one < index ? index - one + 0.5 : one - index);
    const near = numbers.map((_, one) => one).filter((one) => one >= index - behind && one <= index + ahead);
    this.images.want(near.sort((one, other) => distance(one) - distance(other)).map((one) => numbers[one]));
  }

  /**
   * A question that is open, or a frame that is loading, is not asked or loaded twice.
   * @param {() => Promise<unknown>} work
   */
  async _alone(work) {
    if (this._busy) return;
    this._busy = true;
    try {
      await work();
    } catch (error) {
      this._sayNotLoaded(error);
    } finally {
      this._busy = false;
    }
  }

  /** @param {unknown} error */
  _sayNotLoaded(error) {
    this.notices.say(
      gettext("The frame could not be loaded: {reason}. Please try again", { reason: failureWords(error) }),
    );
  }
}
