/**
 * The scripted annotator with everybody side by side. Where somebody's feet are is seen in the tiles, and clicks go
 * there. `plan.eyes`: whether a box stands right is seen in the tiles, too, by eyes as unsure as the hand; otherwise
 * the truth is known, as by the other annotators.
 */
import { Annotator, SAME, tick } from "./effort_annotator.js";
import { NEAR } from "./effort_steps.js";

const TRIES = 6; // clicks on one person, after which arrow keys do it
const CLICKS = 1.4; // clicks a person takes, about
const SURE = 2; // of the eye's own unsureness: so far beyond the ring somebody clearly stands elsewhere

export class SheetAnnotator extends Annotator {
  async run() {
    const { numbers } = this.store;
    this._hands.key("S", { shiftKey: true });
    for (let wait = 0; !this.sheet()?.shown; wait += 1) {
      if (wait > 100) throw new Error("the sheet does not open");
      await new Promise((done) => setTimeout(done, 100)); // it is fetched
    }
    for (const [index, number] of numbers.entries()) {
      await this._work();
      const next = numbers[index + 1];
      const leave = () => this._acceptRest();
      if (next === undefined) leave();
      else await this._go(next, leave);
      if (this.store.people(number).size === 0) throw new Error(`nobody is marked in ${number}`);
    }
  }

  report() {
    const off = this.store.numbers.flatMap((number) => this._wrongIn(number));
    const { persons, counts, wrong } = super.report();
    return { persons, counts, wrong: this.plan.eyes ? [] : wrong, near: 1 - off.length / persons };
  }

  async _work() {
    this._hands.spent = 0;
    await this._see();
    for (let missing = this._notShown(); ; missing = this._notShown()) {
      if (missing.length) await this._placeInViews(missing);
      for (const cell of [...this.sheet().cells]) {
        if (cell.shown.state !== "refused") await this._settle(cell);
      }
      if (!this._notShown().length) return; // whoever is put beside a proposal takes it away from somebody else
    }
  }

  async _see() {
    await tick();
    await tick();
    this._hands.look();
    this._matched = this._match();
  }

  /** Of which person of the truth each cell is: by the number, else whoever is nearest. */
  _match() {
    const cells = this.sheet().cells.filter(({ shown }) => shown.state !== "refused");
    const matched = new Map();
    for (const cell of cells) {
      const id = this._who.get(cell.shown.person);
      if (id !== undefined) matched.set(cell, this._truth.get(this.store.current).has(id) ? id : null);
    }
    const taken = new Set(matched.values());
    const pairs = cells
      .filter((cell) => !matched.has(cell))
      .flatMap((cell) =>
        [...this._truth.get(this.store.current)]
          .filter(([id]) => !taken.has(id) && !this._number.has(id))
          .map(([id, there]) => ({ cell, id, away: this._apart(cell.shown.placed.position, there) })),
      )
      .filter(({ away }) => away <= SAME)
      .sort((one, other) => one.away - other.away);
    for (const { cell, id } of pairs) {
      if (matched.has(cell) || taken.has(id)) continue;
      matched.set(cell, id);
      taken.add(id);
    }
    return matched;
  }

  _notShown() {
    const shown = new Set(this._matched.values());
    return [...this._truth.get(this.store.current).keys()].filter((id) => !shown.has(id));
  }

  /** Who has no tile is placed in the views. */
  async _placeInViews(missing) {
    this._hands.key("S", { shiftKey: true });
    for (const id of missing) {
      if (this._number.has(id)) this._forget(id); // who comes back is somebody new here
      this._place(id);
    }
    this._hands.key("S", { shiftKey: true });
    await this._see();
  }

  _forget(id) {
    this._who.delete(this._number.get(id));
    this._number.delete(id);
  }

  async _settle(cell) {
    const id = this._matched.get(cell) ?? null;
    if (id === null) {
      this._hands.pointAtTile(cell);
      this._hands.key("Backspace");
      return this._see();
    }
    const truth = this._truth.get(this.store.current).get(id);
    let pointed = false;
    for (let tries = 0; this._isOff(cell, truth); tries += 1) {
      const arrow = this._arrow(cell, truth, pointed, tries);
      const tile = arrow ? null : this._worstTile(cell, truth);
      if (arrow) this._hands.key(arrow.key, { shiftKey: arrow.far });
      else if (tile) this._hands.clickTile(cell, this._aim(tile));
      else return this._moveInViews(cell, id);
      pointed = true;
      await this._see();
      this._note(cell, id);
      if (this.plan.eyes && tries + 1 >= TRIES) return;
    }
  }

  /** An arrow key, where that is over sooner than a click. */
  _arrow(cell, truth, pointed, tries) {
    const [anchor] = cell.anchors;
    if (this.plan.eyes || !anchor) return null;
    const step = this._hands.arrowIn(anchor.view, cell.shown.placed, truth, cell.shown.person);
    if (!pointed && step.cost + 1 > CLICKS) return null;
    return step.cost <= CLICKS || tries >= TRIES ? step : null;
  }

  _isOff(cell, truth) {
    if (!this.plan.eyes) return this._apart(cell.shown.placed.position, truth) > NEAR + 1e-9;
    return this._tiles(cell, truth).some((tile) => this._looksOff(tile));
  }

  /** Whether the feet lie clearly beyond the ring that is drawn around the foot of the box. */
  _looksOff({ view, transform, marked, seen }) {
    const eye = { x: seen.x + this._hands.miss(transform.scale), y: seen.y + this._hands.miss(transform.scale) };
    const source = transform.toSource(eye.x, eye.y);
    const ground = this.scene.toGround(view, source);
    const centre = this.scene.metres(marked);
    if (!ground) return true;
    const away = Math.hypot(ground.x - centre.x, ground.y - centre.y);
    if (away <= NEAR) return false;
    const [x, y] = ["x", "y"].map((axis) => centre[axis] + ((ground[axis] - centre[axis]) * NEAR) / away);
    const edge = this.scene.toImage(view, { x, y });
    const border = edge && transform.toPane(edge.x, edge.y);
    const sure = SURE * this._hands.sigma(transform.scale);
    return !border || Math.hypot(border.x - eye.x, border.y - eye.y) > sure;
  }

  /** The tiles of a cell that show the feet: where those are, and the box. */
  _tiles(cell, truth) {
    const marked = cell.shown.placed.position;
    return cell.tiles().flatMap(({ view, area, transform }) => {
      const [foot, mark] = [truth, marked].map((position) => this.scene.toImage(view, this.scene.metres(position)));
      if (!foot || !mark) return [];
      const [seen, drawn] = [foot, mark].map(({ x, y }) => transform.toPane(x, y));
      const inside = seen.x > area.x && seen.x < area.x + area.width && seen.y > 0 && seen.y < area.height;
      return inside ? [{ view, transform, marked, seen, drawn }] : [];
    });
  }

  /** Where it shows most that the box does not stand on the feet. */
  _worstTile(cell, truth) {
    const off = ({ seen, drawn }) => Math.hypot(seen.x - drawn.x, seen.y - drawn.y);
    return this._tiles(cell, truth).sort((one, other) => off(other) - off(one))[0] ?? null;
  }

  _aim({ seen, transform }) {
    return { x: seen.x + this._hands.miss(transform.scale), y: seen.y + this._hands.miss(transform.scale) };
  }

  /** Too far off for the tiles: chosen in the list, and clicked on in the views. */
  async _moveInViews(cell, id) {
    const { person } = cell.shown;
    if (person === null || !this.store.person(person)) throw new Error(`${id} is in no tile`);
    this._hands.key("S", { shiftKey: true });
    await tick();
    this._hands.pointAtMap();
    this._hands.clickRow(person);
    while (!this._isNear(person)) this._improve(person);
    if (this.store.person(person).state === "carried") this._hands.key("e");
    this._hands.key("S", { shiftKey: true });
    await this._see();
  }

  /** @param {number} id of the truth */
  _note(cell, id) {
    const { person } = cell.shown;
    if (person === null || this._who.has(person)) return;
    this._who.set(person, id);
    this._number.set(id, person);
  }

  _acceptRest() {
    const matched = [...this._matched];
    this._hands.key("Enter", { shiftKey: true });
    for (const [cell, id] of matched) {
      const one = this.store.occupant(cell.shown.placed.position);
      if (!one || id === null || this._who.has(one.person)) continue;
      this._who.set(one.person, id);
      this._number.set(id, one.person);
    }
  }

  _apart(one, other) {
    const [here, there] = [one, other].map((position) => this.scene.metres(position));
    return Math.hypot(here.x - there.x, here.y - there.y);
  }
}
