/**
 * A scripted annotator at the real workbench. It sees the truth and decides perfectly; its hands are real events
 * at the real page, and every key press and every click is counted. Clicks miss by a normal error.
 */
import { Queue } from "/static/workbench/people/queue.js";
import { NEAR } from "./effort_steps.js";

export const SAME = 0.5; // metres between somebody proposed and the truth

export class Annotator {
  constructor({ scene, store }, hands, truth, plan) {
    Object.assign(this, { scene, store, plan });
    this._hands = hands;
    this._queue = new Queue({ scene, store });
    this._truth = new Map(
      truth.map((people, index) => [
        store.numbers[index],
        new Map(Object.entries(people).map(([id, position]) => [Number(id), position])),
      ]),
    );
    this._number = new Map(); // of the truth's people, in the workbench
    this._who = new Map(); // and back
  }

  report() {
    const persons = [...this._truth.values()].reduce((sum, people) => sum + people.size, 0);
    const wrong = this.store.numbers.flatMap((number) => this._wrongIn(number));
    return { counts: this._hands.counts, persons, wrong };
  }

  async run() {
    const { numbers } = this.store;
    this._hands.pointAtMap();
    if (this.plan.round) this._hands.key("a");
    const every = this.plan.keyframes ?? 1;
    if (every > 1) {
      for (let index = 0; index < numbers.length; index += every) await this._visit(numbers[index], index > 0);
      await this._visit(numbers[0], true);
    }
    for (let index = 0; index < numbers.length; index += 1) {
      if (index > 0) await this._go(numbers[index], () => this._hands.key("n"));
      await this._work();
    }
    this._hands.key("n"); // the last frame is done, too
  }

  async _visit(number, jump) {
    if (jump) await this._go(number, () => this._hands.clickTimeline(number));
    await this._work();
  }

  async _go(number, how) {
    how();
    for (let wait = 0; this.store.current !== number; wait += 1) {
      if (wait > 200)
        throw new Error(
          `still in ${this.store.current}, not in ${number}: ${document.querySelector("dialog")?.textContent}`,
        );
      await tick();
    }
    await tick();
    await tick();
    if (this.plan.copies) this._standStill();
  }

  /** Carried over as the original does it: everybody exactly where he was. */
  _standStill() {
    const before = this.store.people(this.store.neighbour(-1));
    const edits = [...this.store.people().values()].map((one) => ({
      frame: this.store.current,
      person: one.person,
      after: Object.freeze({ ...one, position: before.get(one.person).position }),
    }));
    this.store.apply(edits);
  }

  async _work() {
    this._hands.spent = 0;
    if (this.plan.keyframes && this._cameLater().length) {
      this._hands.key("j");
      await tick();
      await tick();
    }
    if (this.plan.proposals) this._acceptProposed();
    if (this.plan.round) return this._goRound();
    for (const id of this._missing()) this._placeAndCorrect(id);
    for (;;) {
      const waiting = this._yellow();
      if (!waiting.length) return;
      this._hands.key("f");
      this._correctSelected();
    }
  }

  /** All right ones by one key; whoever of them is not right, or nobody, is gone to by a click on the list. */
  _acceptProposed() {
    this._hands.key("o");
    const accepted = [...this.store.people().values()].filter(({ origin }) => origin === "proposed");
    for (const one of accepted) this._recognise(one);
    for (const { person } of accepted) {
      const wrong = !this._who.has(person) || !this._here(person);
      if (!wrong && this._isNear(person)) continue;
      this._hands.clickRow(person);
      if (wrong) this._hands.key("Backspace");
      else while (!this._isNear(person)) this._improve(person);
    }
  }

  /** Whom of the truth somebody accepted is. */
  _recognise({ person, position }) {
    if (this._who.has(person)) return;
    const { x, y } = this.scene.metres(position);
    for (const [id, there] of this._truth.get(this.store.current)) {
      const truth = this.scene.metres(there);
      if (this._number.has(id) || Math.hypot(truth.x - x, truth.y - y) > SAME) continue;
      this._number.set(id, person);
      this._who.set(person, id);
      return;
    }
  }

  /** One after the other without any of the round's help: select, move, validate. */
  _correctSelected() {
    const { person } = this.store.selected();
    if (!this._who.has(person) || !this._here(person)) return this._hands.key("Backspace");
    if (this.plan.zoom && this._hands.seesAll) this._hands.key("z");
    while (!this._isNear(person)) this._improve(person);
    if (this.store.person(person).state === "carried") this._hands.key("e");
  }

  _placeAndCorrect(id) {
    this._place(id);
    const person = this.store.selection;
    while (!this._isNear(person)) this._improve(person);
  }

  _goRound() {
    for (;;) {
      const one = this.store.selected();
      if (!one) {
        if (this._yellow().length) this._hands.key("f");
        else if (this._missing().length) this._place(this._missing()[0]);
        else return;
      } else if (!this._here(one.person)) this._hands.key("Backspace");
      else if (!this._isNear(one.person)) this._putRight(one.person);
      else if (!this._goOn(one)) return;
    }
  }

  /** A right click goes on at once; whoever was missed is fetched back. */
  _putRight(person) {
    const clicks = this._improve(person);
    if (clicks && !this._isNear(person) && this.store.selection !== person) this._hands.key("b");
  }

  /** @returns {boolean} whether there is anything left to do in this frame */
  _goOn(one) {
    const wrong = this._yellow().filter(
      ({ person }) => person !== one.person && !(this._here(person) && this._isNear(person)),
    );
    const right = this._yellow().length - wrong.length;
    if (!right && !wrong.length && !this._missing().length) return false;
    const next = this._queue.next(one.person);
    if (!this.plan.skip || (wrong.length && one.state === "carried" && wrong.includes(next))) this._hands.key("Enter");
    else if (wrong.length) this._hands.clickRow(wrong[0].person);
    else if (right) this._hands.key("Enter", { shiftKey: true });
    else this._hands.key("Enter");
    return true;
  }

  /** By click or by arrow, whichever will be over sooner. @returns {boolean} whether it was a click */
  _improve(person) {
    const truth = this._here(person);
    const press = this._hands.arrow(this.store.person(person).position, truth);
    const view = this.plan.clicks && this._hands.bestView(truth);
    // One by one a click goes on by itself, unless it has to be mended; after arrow keys Enter goes on.
    const [byKeys, byClicks] = this.plan.round ? [press.cost + 1, 2 * view?.cost - 1] : [press.cost, view?.cost];
    if (!view || byKeys <= byClicks) {
      this._hands.key(press.key, { shiftKey: press.far });
      return false;
    }
    this._hands.rightClick(view, truth);
    return true;
  }

  _yellow() {
    return [...this.store.people().values()]
      .filter(({ state }) => state === "carried")
      .sort((one, other) => one.person - other.person);
  }

  _missing(number = this.store.current) {
    const people = this.store.people(number);
    return [...this._truth.get(number).keys()].filter((id) => !people.has(this._number.get(id)));
  }

  /** Missing here, but known from a later keyframe. */
  _cameLater() {
    const after = this.store.numbers
      .slice(this.store.numbers.indexOf(this.store.current) + 1)
      .find((number) => this.store.people(number).size);
    const later = after === undefined ? new Map() : this.store.people(after);
    return this.store.people().size ? this._missing().filter((id) => later.has(this._number.get(id))) : [];
  }

  _here(person, number = this.store.current) {
    return this._truth.get(number).get(this._who.get(person));
  }

  _isNear(person, number = this.store.current) {
    const [one, other] = [this.store.person(person, number).position, this._here(person, number)].map((position) =>
      this.scene.metres(position),
    );
    return Math.hypot(one.x - other.x, one.y - other.y) <= NEAR + 1e-9;
  }

  _wrongIn(number) {
    const people = [...this.store.people(number).values()];
    const wrong = people.filter(
      (one) =>
        this._here(one.person, number) === undefined || one.state !== "validated" || !this._isNear(one.person, number),
    );
    return [
      ...wrong.map(({ person }) => `${number}: person ${person}`),
      ...this._missing(number).map((id) => `${number}: ${id} is missing`),
    ];
  }

  _place(id) {
    const position = this._truth.get(this.store.current).get(id);
    const before = this.store.people().size;
    while (this.store.people().size === before) this._hands.place(position);
    this._number.set(id, this.store.selection);
    this._who.set(this.store.selection, id);
  }
}

export function tick() {
  return new Promise((done) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = done;
    port2.postMessage(null);
  });
}
