/**
 * A scripted annotator at the real workbench. It sees the truth and decides perfectly; its hands are real events
 * at the real page, and every key press and every click is counted. Clicks miss by a normal error.
 */
import { Activity } from "/static/saving/activity.js";
import { Journal } from "/static/saving/journal.js";
import { Loader } from "/static/saving/loader.js";
import { Saver } from "/static/saving/saver.js";
import { History } from "/static/truth/history.js";
import { withRefill } from "/static/truth/keyframes.js";
import { Scene } from "/static/truth/scene.js";
import { Store } from "/static/truth/store.js";
import { Images } from "/static/views/images.js";
import { Panes } from "/static/views/panes.js";
import { Queue } from "/static/workbench/people/queue.js";
import { buildWorkbench } from "/static/workbench/workbench.js";

const SAME = 0.5; // metres between somebody proposed and the truth
const NEAR = 0.05; // metres from the truth that are near enough
const FAR = 10; // positions a step with Shift goes
const SCREEN = 3; // CSS pixels, standard deviation of a click along each axis
const IMAGE = 1; // image pixels a picture leaves open, however far one zooms in
const PATIENCE = 24_000; // actions in one frame after which something is wrong

const panes = new Map(); // view → pane, noted as the page builds them

/** @param {{scene: object, truth: Object<string, number>[], plan: object, seed: number}} job */
export async function work({ scene: json, truth, plan, seed, proposed }) {
  const add = Panes.prototype.addExtra;
  Panes.prototype.addExtra = function noted(extra) {
    for (const pane of this.all) panes.set(pane.view.index ?? "map", pane);
    add.call(this, extra);
  };
  Element.prototype.setPointerCapture = () => {}; // made-up pointers cannot be captured
  const session = makeSession(new Scene(json), await Journal.open(null), proposed);
  buildWorkbench(document.getElementById("workbench"), session, { mode: "assignment", home: "/" });
  await new Promise((done) => setTimeout(done, 300)); // until the panes know their size
  const annotator = new Annotator(session, truth, plan, seed);
  await annotator.run();
  return annotator.report();
}

function makeSession(scene, journal, proposed) {
  const empty = scene.frames.map(({ number }) => ({
    number,
    revision: 0,
    annotations: [],
    done: false,
    nobody: false,
  }));
  const api = {
    ask: async () => proposed,
    frames: async () => ({ frames: empty }),
    blob: () => Promise.reject(new Error("no pictures here")),
  };
  const store = new Store(
    scene.frames.map(({ number }) => number),
    scene.nextPerson,
  );
  const loader = new Loader({ api, scene, store });
  const activity = new Activity();
  const saver = new Saver({ api, store, journal, activity, practice: true });
  const history = new History(store, (patch) => withRefill(store, scene, patch));
  loader.connect(saver, empty);
  return { api, scene, store, history, saver, loader, journal, images: new Images(api, scene), activity };
}

class Annotator {
  constructor({ scene, store }, truth, plan, seed) {
    Object.assign(this, { scene, store, plan });
    this._queue = new Queue({ scene, store });
    this._truth = new Map(
      truth.map((people, index) => [
        store.numbers[index],
        new Map(Object.entries(people).map(([id, position]) => [Number(id), position])),
      ]),
    );
    this._number = new Map(); // of the truth's people, in the workbench
    this._who = new Map(); // and back
    this._random = normal(seed);
    this._counts = {};
    this._paints = [];
    this._spent = 0;
    // Nobody looks: what waits for the next picture is done only when a row of the list is needed.
    window.requestAnimationFrame = (paint) => this._paints.push(paint);
  }

  report() {
    const persons = [...this._truth.values()].reduce((sum, people) => sum + people.size, 0);
    const wrong = this.store.numbers.flatMap((number) => this._wrongIn(number));
    return { counts: this._counts, persons, wrong };
  }

  async run() {
    const { numbers } = this.store;
    this._pointAt(panes.get("map"));
    if (this.plan.round) this._key("a");
    const every = this.plan.keyframes ?? 1;
    if (every > 1) {
      for (let index = 0; index < numbers.length; index += every) await this._visit(numbers[index], index > 0);
      await this._visit(numbers[0], true);
    }
    for (let index = 0; index < numbers.length; index += 1) {
      if (index > 0) await this._go(numbers[index], () => this._key("n"));
      await this._work();
    }
    this._key("n"); // the last frame is done, too
  }

  async _visit(number, jump) {
    if (jump) await this._go(number, () => this._clickTimeline(number));
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
    this._spent = 0;
    if (this.plan.keyframes && this._cameLater().length) {
      this._key("j");
      await tick();
      await tick();
    }
    if (this.plan.proposals) this._acceptProposed();
    if (this.plan.round) return this._goRound();
    for (const id of this._missing()) this._placeAndCorrect(id);
    for (;;) {
      const waiting = this._yellow();
      if (!waiting.length) return;
      this._key("f");
      this._correctSelected();
    }
  }

  /** All right ones by one key; whoever of them is not right, or nobody, is gone to by a click on the list. */
  _acceptProposed() {
    this._key("o");
    const accepted = [...this.store.people().values()].filter(({ origin }) => origin === "proposed");
    for (const one of accepted) this._recognise(one);
    for (const { person } of accepted) {
      const wrong = !this._who.has(person) || !this._here(person);
      if (!wrong && this._isNear(person)) continue;
      this._clickRow(person);
      if (wrong) this._key("Backspace");
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
    if (!this._who.has(person) || !this._here(person)) return this._key("Backspace");
    if (this.plan.zoom && [...panes.values()].every(({ fitted }) => fitted)) this._key("z");
    while (!this._isNear(person)) this._improve(person);
    if (this.store.person(person).state === "carried") this._key("e");
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
        if (this._yellow().length) this._key("f");
        else if (this._missing().length) this._place(this._missing()[0]);
        else return;
      } else if (!this._here(one.person)) this._key("Backspace");
      else if (!this._isNear(one.person)) this._putRight(one.person);
      else if (!this._goOn(one)) return;
    }
  }

  /** A right click goes on at once; whoever was missed is fetched back. */
  _putRight(person) {
    const clicks = this._improve(person);
    if (clicks && !this._isNear(person) && this.store.selection !== person) this._key("b");
  }

  /** @returns {boolean} whether there is anything left to do in this frame */
  _goOn(one) {
    const wrong = this._yellow().filter(
      ({ person }) => person !== one.person && !(this._here(person) && this._isNear(person)),
    );
    const right = this._yellow().length - wrong.length;
    if (!right && !wrong.length && !this._missing().length) return false;
    const next = this._queue.next(one.person);
    if (!this.plan.skip || (wrong.length && one.state === "carried" && wrong.includes(next))) this._key("Enter");
    else if (wrong.length) this._clickRow(wrong[0].person);
    else if (right) this._key("Enter", { shiftKey: true });
    else this._key("Enter");
    return true;
  }

  /** By click or by arrow, whichever will be over sooner. @returns {boolean} whether it was a click */
  _improve(person) {
    const truth = this._here(person);
    const press = this._arrow(this.store.person(person).position, truth);
    const view = this.plan.clicks && this._bestView(truth);
    // One by one a click goes on by itself, unless it has to be mended; after arrow keys Enter goes on.
    const [byKeys, byClicks] = this.plan.round ? [press.cost + 1, 2 * view?.cost - 1] : [press.cost, view?.cost];
    if (!view || byKeys <= byClicks) {
      this._key(press.key, { shiftKey: press.far });
      return false;
    }
    this._rightClick(view, truth);
    return true;
  }

  // What there is to see

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

  // Hands

  _count(kind) {
    this._counts[kind] = (this._counts[kind] ?? 0) + 1;
    this._spent += 1;
    if (this._spent > PATIENCE) throw new Error(`stuck in frame ${this.store.current}`);
  }

  _key(key, modifiers = {}) {
    this._count(key.startsWith("Arrow") ? "arrow keys" : "other keys");
    const init = { key, bubbles: true, cancelable: true, ...modifiers };
    document.body.dispatchEvent(new KeyboardEvent("keydown", init));
    document.body.dispatchEvent(new KeyboardEvent("keyup", init));
  }

  _pointAt(pane) {
    pane.element.dispatchEvent(new PointerEvent("pointerenter", {}));
  }

  _place(id) {
    const position = this._truth.get(this.store.current).get(id);
    const before = this.store.people().size;
    while (this.store.people().size === before) {
      this._count("clicks");
      const { pane, sigma } = this._bestView(position) ?? { pane: panes.get("map"), sigma: SCREEN };
      const init = {
        ...this._aim(pane, position, sigma),
        button: 0,
        pointerId: 1,
        shiftKey: true,
        bubbles: true,
        cancelable: true,
      };
      pane.element.dispatchEvent(new PointerEvent("pointerdown", init));
      pane.element.dispatchEvent(new PointerEvent("pointerup", init));
      this._pointAt(panes.get("map"));
    }
    this._number.set(id, this.store.selection);
    this._who.set(this.store.selection, id);
  }

  _rightClick({ pane, sigma }, position) {
    this._count("clicks");
    pane.element.dispatchEvent(
      new MouseEvent("contextmenu", {
        ...this._aim(pane, position, sigma),
        button: 2,
        bubbles: true,
        cancelable: true,
      }),
    );
  }

  _clickRow(person) {
    this._count("clicks");
    for (const paint of this._paints.splice(0)) paint(performance.now());
    [...document.querySelectorAll(".people li")]
      .find((row) => row.querySelector(".number").textContent === String(person))
      .click();
  }

  _clickTimeline(number) {
    this._count("clicks");
    const { left, top, width, height } = document
      .querySelector(`.timeline-frame[data-number="${number}"]`)
      .getBoundingClientRect();
    const init = {
      clientX: left + width / 2,
      clientY: top + height / 2,
      button: 0,
      pointerId: 1,
      bubbles: true,
      cancelable: true,
    };
    const frames = document.querySelector(".timeline-frames");
    for (const type of ["pointerdown", "pointerup"]) frames.dispatchEvent(new PointerEvent(type, init));
  }

  _aim(pane, position, sigma) {
    const { x, y } = onPane(pane, this.scene.metres(position));
    const bounds = pane.element.getBoundingClientRect();
    return { clientX: bounds.left + x + sigma * this._random(), clientY: bounds.top + y + sigma * this._random() };
  }

  /** The pane in which a click lands nearest, and how many clicks it takes until one is near enough. */
  _bestView(position) {
    const ground = this.scene.metres(position);
    let best = null;
    for (const pane of panes.values()) {
      if (pane.view.index === null) continue;
      const spread = this._spread(pane, ground);
      if (spread && (!best || spread.variance < best.variance)) best = { pane, ...spread };
    }
    if (!best) return null;
    // Rayleigh's distribution, as if the error were the same along both axes of the ground
    return { ...best, cost: 1 / (1 - Math.exp(-(NEAR ** 2) / best.variance)) };
  }

  /** Where clicks land on the ground: the sum of their variances, m²; null where the feet are not to be seen. */
  _spread(pane, ground) {
    const seen = pane.view.point(ground);
    const { width, height } = pane.view.size;
    if (!seen || seen.x < 0 || seen.y < 0 || seen.x >= width || seen.y >= height) return null;
    const at = pane.transform.toPane(seen.x, seen.y);
    if (at.x < 2 || at.y < 2 || at.x > pane.room.width - 2 || at.y > pane.room.height - 2) return null;
    const [right, up] = [
      onPane(pane, { x: ground.x + 0.01, y: ground.y }),
      onPane(pane, { x: ground.x, y: ground.y + 0.01 }),
    ];
    const [a, b, c, d] = [right.x - at.x, up.x - at.x, right.y - at.y, up.y - at.y].map((pixels) => pixels / 0.01);
    const sigma = Math.hypot(SCREEN, (this.plan.imagePixels ?? IMAGE) * pane.transform.scale);
    return { sigma, variance: (sigma ** 2 * (a * a + b * b + c * c + d * d)) / (a * d - b * c) ** 2 };
  }

  /** By somebody else: an arrow key goes past him, and never onto his position. */
  _isOccupied(position) {
    return Boolean(this.store.occupant(position, this.store.selection));
  }

  /** The next press on the shortest way, and how many there are. */
  _arrow(from, to) {
    const { columns, rows } = this.scene.grid;
    const [x0, y0] = [from % columns, Math.floor(from / columns)];
    const [dx, dy] = [(to % columns) - x0, Math.floor(to / columns) - y0];
    const inside = {
      x: (cells) => x0 + cells >= 0 && x0 + cells < columns,
      y: (cells) => y0 + cells >= 0 && y0 + cells < rows,
    };
    const reach = Math.floor(NEAR / this.scene.grid.step + 1e-9);
    let best = { cost: Infinity };
    for (let i = -reach; i <= reach; i += 1) {
      for (let j = -reach; j <= reach; j += 1) {
        if (Math.hypot(i, j) > reach || this._isOccupied(to - i - j * columns)) continue;
        const [x, y] = [presses(dx - i, this.plan.far, inside.x), presses(dy - j, this.plan.far, inside.y)];
        if (x.cost + y.cost < best.cost) best = { cost: x.cost + y.cost, x, y };
      }
    }
    const along = best.x.cost ? "x" : "y";
    const { sign, far } = best[along];
    const axes = panes.get("map").view.axes();
    const wanted = along === "x" ? { columns: sign, rows: 0 } : { columns: 0, rows: sign };
    const name = Object.keys(axes).find(
      (one) => axes[one].columns === wanted.columns && axes[one].rows === wanted.rows,
    );
    return {
      cost: best.cost,
      far,
      key: { left: "ArrowLeft", right: "ArrowRight", up: "ArrowUp", down: "ArrowDown" }[name],
    };
  }
}

/** Presses along one axis, coarse ones first: {cost, sign and far of the next one}. */
function presses(cells, mayFar, inside) {
  const far = Math.trunc(cells / FAR);
  const coarse = mayFar ? [0, far, far + Math.sign(cells)].filter((steps) => inside(FAR * steps)) : [0];
  const options = coarse.map((steps) => ({
    steps,
    rest: cells - FAR * steps,
    cost: Math.abs(steps) + Math.abs(cells - FAR * steps),
  }));
  const best = options.reduce((one, other) => (other.cost < one.cost ? other : one));
  return { cost: best.cost, far: best.steps !== 0, sign: Math.sign(best.steps || best.rest) };
}

function onPane(pane, ground) {
  const { x, y } = pane.view.point(ground);
  return pane.transform.toPane(x, y);
}

function tick() {
  return new Promise((done) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = done;
    port2.postMessage(null);
  });
}

/** Normal numbers out of a seed (mulberry32, Box and Muller). */
function normal(seed) {
  let state = seed >>> 0;
  const uniform = () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let mixed = Math.imul(state ^ (state >>> 15), state | 1);
    mixed ^= mixed + Math.imul(mixed ^ (mixed >>> 7), mixed | 61);
    return ((mixed ^ (mixed >>> 14)) >>> 0) / 4294967296;
  };
  return () => Math.sqrt(-2 * Math.log(1 - uniform())) * Math.cos(2 * Math.PI * uniform());
}
