/** Hands of the scripted annotator: real events at the real page, each of them counted. Clicks miss by a normal error. */
import { NEAR, shortestWay } from "./effort_steps.js";

const SCREEN = 3; // CSS pixels, standard deviation of a click along each axis, unless the plan says otherwise
const IMAGE = 1; // image pixels a picture leaves open, however far one zooms in
const PATIENCE = 24_000; // actions in one frame after which something is wrong

export class Hands {
  constructor({ scene, store }, panes, plan, seed) {
    Object.assign(this, { scene, store, plan, counts: {}, spent: 0 });
    this._panes = panes;
    this._random = normal(seed);
    this._paints = [];
    // Nobody looks: what waits for the next picture is done only when a row of the list is needed.
    window.requestAnimationFrame = (paint) => this._paints.push(paint);
  }

  _count(kind) {
    this.counts[kind] = (this.counts[kind] ?? 0) + 1;
    this.spent += 1;
    if (this.spent > PATIENCE) throw new Error(`stuck in frame ${this.store.current}`);
  }

  key(key, modifiers = {}) {
    this._count(key.startsWith("Arrow") ? "arrow keys" : "other keys");
    const init = { key, bubbles: true, cancelable: true, ...modifiers };
    document.body.dispatchEvent(new KeyboardEvent("keydown", init));
    document.body.dispatchEvent(new KeyboardEvent("keyup", init));
  }

  pointAtMap() {
    this._map.element.dispatchEvent(new PointerEvent("pointerenter", {}));
  }

  get _screen() {
    return this.plan.screen ?? SCREEN;
  }

  /** What was done is on the screen. */
  look() {
    while (this._paints.length) for (const paint of this._paints.splice(0)) paint(performance.now());
  }

  /** A deviation, as a hand's or an eye's at something that is shown so large. @param {number} scale */
  miss(scale) {
    return this.sigma(scale) * this._random();
  }

  /** CSS pixels along each axis. */
  sigma(scale) {
    return Math.hypot(this._screen, (this.plan.imagePixels ?? IMAGE) * scale);
  }

  /** The pointer goes to a tile of the sheet. */
  pointAtTile(cell) {
    this._count("clicks");
    this._overTile("pointermove", cell, middleOf(cell));
  }

  clickTile(cell, at) {
    this._count("clicks");
    this._overTile("pointermove", cell, at);
    this._overTile("click", cell, at);
  }

  _overTile(type, { canvas }, { x, y }) {
    const { left, top } = canvas.getBoundingClientRect();
    const Kind = type === "click" ? MouseEvent : PointerEvent;
    const init = { clientX: left + x, clientY: top + y, bubbles: true, cancelable: true };
    canvas.dispatchEvent(new Kind(type, init));
  }

  get _map() {
    return this._panes.get("map");
  }

  /** Whether no pane is zoomed. */
  get seesAll() {
    return [...this._panes.values()].every(({ fitted }) => fitted);
  }

  /** Shift and a click, where somebody is missing. */
  place(position) {
    this._count("clicks");
    const { pane, sigma } = this.bestView(position) ?? { pane: this._map, sigma: this._screen };
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
    this.pointAtMap();
  }

  rightClick({ pane, sigma }, position) {
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

  clickRow(person) {
    this._count("clicks");
    this.look();
    [...document.querySelectorAll(".people li")]
      .find((row) => row.querySelector(".number").textContent === String(person))
      .click();
  }

  clickTimeline(number) {
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
  bestView(position) {
    const ground = this.scene.metres(position);
    let best = null;
    for (const pane of this._panes.values()) {
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
    const sigma = Math.hypot(this._screen, (this.plan.imagePixels ?? IMAGE) * pane.transform.scale);
    return { sigma, variance: (sigma ** 2 * (a * a + b * b + c * c + d * d)) / (a * d - b * c) ** 2 };
  }

  /** The next press on the shortest way, and how many there are; it goes past others, and never onto them. */
  arrow(from, to) {
    const isOccupied = (position) => Boolean(this.store.occupant(position, this.store.selection));
    const rules = { mayFar: this.plan.far, isOccupied };
    const { cost, along, sign, far } = shortestWay(this.scene.grid, from, to, rules);
    return { cost, far, key: this._keyOf(this._map.view.axes(), along, sign) };
  }

  /** The same as one view shows it. */
  arrowIn(view, from, to, person) {
    const isOccupied = (position) => Boolean(this.store.occupant(position, person));
    const rules = { mayFar: this.plan.far, isOccupied };
    const { cost, along, sign, far } = shortestWay(this.scene.grid, from.position, to, rules);
    return { cost, far, key: this._keyOf(this._panes.get(view).view.axes(from), along, sign) };
  }

  _keyOf(axes, along, sign) {
    const wanted = along === "x" ? { columns: sign, rows: 0 } : { columns: 0, rows: sign };
    const name = Object.keys(axes).find(
      (one) => axes[one].columns === wanted.columns && axes[one].rows === wanted.rows,
    );
    return { left: "ArrowLeft", right: "ArrowRight", up: "ArrowUp", down: "ArrowDown" }[name];
  }
}

function middleOf({ canvas }) {
  return { x: canvas.clientWidth / 2, y: canvas.clientHeight / 2 };
}

function onPane(pane, ground) {
  const { x, y } = pane.view.point(ground);
  return pane.transform.toPane(x, y);
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
