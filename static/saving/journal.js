/**
 * @typedef {import("../truth/history.js").Stacks} Stacks
 * @typedef {import("./database.js").Database} Database
 * @typedef {import("./edit_record.js").StoredRecord} StoredRecord
 * @typedef {import("./tabs.js").Tab} Tab
 * @typedef {StoredRecord & {layer: string, tab: string, frame: number}} FrameRecord
 * @typedef {FrameRecord & {formerly?: boolean}} Recovered `formerly`: kept under the name of earlier versions
 * @typedef {Stacks & {layer: string, tab: string, at: number}} HistoryRecord
 * @typedef {{layer: string, database: Database, tab: Tab}} Open what there is to write with
 */
import { DISMISSED, FRAMES, HISTORIES, openDatabase } from "./database.js";
import { joinTabs, shareNumbers } from "./tabs.js";

const PAUSE_OF_HISTORY = 1000; // ms between two writes; undo steps are worth less than what is annotated

/**
 * Keeps what the server has not acknowledged, so that a crash, a closed lid or an expired session loses nothing.
 * Writing never blocks an edit: one write at a time per record, always of the newest value. Edits are written at
 * once, those that come during a write together after it: a browser that is killed loses what is being written.
 */
export class Journal {
  /**
   * @param {string|null} layer whose edits: a name no other layer has, on no server; null: nothing is kept (tutorial)
   * @param {string|null} [formerly] its name in earlier versions, which layers of other databases may have, too
   */
  static async open(layer, formerly = null) {
    if (layer === null) return new Journal(layer, null, null);
    try {
      const [database, tab] = await Promise.all([openDatabase(), joinTabs(layer)]);
      return new Journal(layer, database, tab, formerly);
    } catch (error) {
      console.warn("edits cannot be kept in this browser", error);
      return new Journal(layer, null, null);
    }
  }

  /**
   * @param {string|null} layer @param {Database|null} database @param {Tab|null} tab @param {string|null} [formerly]
   */
  constructor(layer, database, tab, formerly = null) {
    this._layer = layer;
    this._formerly = formerly;
    this._database = database;
    this._tab = tab;
    this._failed = false; // the last write, for want of room for instance
    /** @type {Map<number, [layer: string, tab: string, frame: number][]>} */
    this._takenOver = new Map(); // frame → keys of records that the next write of the frame replaces
    /** @type {Map<string, () => Promise<unknown>>} */
    this._waiting = new Map();
    /** @type {Set<string>} */
    this._writing = new Set();
    /** @type {Map<string, () => void>} */
    this._pauses = new Map(); // record → ends its pause
  }

  /** Whether edits survive a crash in this browser. */
  get keeps() {
    return this._open !== null && !this._failed;
  }

  /** @returns {Open|null} */
  get _open() {
    const { _layer: layer, _database: database, _tab: tab } = this;
    return layer !== null && database?.isOpen && tab ? { layer, database, tab } : null;
  }

  /**
   * From now on this tab and the others of the layer give away different person numbers.
   * @param {import("../truth/store.js").Store} store
   */
  shareNumbers(store) {
    if (this.keeps && this._tab) shareNumbers(this._tab, store);
  }

  /**
   * @param {number} frame
   * @param {() => StoredRecord} record made when it is written, so that a burst of edits costs one write
   */
  write(frame, record) {
    this._queue(`frame ${frame}`, (open) =>
      this._replace(open, frame, { ...record(), layer: open.layer, tab: open.tab.name, frame }),
    );
  }

  /** @param {number} frame */
  clear(frame) {
    this._queue(`frame ${frame}`, (open) => this._replace(open, frame, null));
  }

  /**
   * Edits of this tab before its reload, and of tabs that are gone; oldest first. `formerly`: kept under the
   * name of earlier versions, so they may be another layer's.
   */
  async recover() {
    /** @type {Recovered[]|undefined} */
    const records = await this._tried(async ({ database, layer, tab: { name, alive } }) => {
      const former = this._formerly === null ? [] : await database.ofLayer(FRAMES, this._formerly);
      return [...(await database.ofLayer(FRAMES, layer)), ...former.map((one) => ({ ...one, formerly: true }))].filter(
        ({ tab }) => tab === name || !alive.has(tab),
      );
    });
    return (records ?? []).sort((one, other) => one.at - other.at);
  }

  /**
   * From its next write on, this tab's record of the frame stands for this one as well: never both, never none.
   * @param {{layer: string, tab: string, frame: number}} record
   */
  takeOver({ layer, tab, frame }) {
    if (!this._open || (layer === this._layer && tab === this._tab?.name)) return;
    this._takenOver.set(frame, [...(this._takenOver.get(frame) ?? []), [layer, tab, frame]]);
  }

  /** @param {() => Stacks} dump */
  writeHistory(dump) {
    /** @param {Open} open */
    const work = ({ database, layer, tab }) =>
      database.put(HISTORIES, { layer, tab: tab.name, at: Date.now(), ...dump() });
    this._queue("history", work, PAUSE_OF_HISTORY);
  }

  /** Write what waits: the page goes away. */
  hurry() {
    for (const end of this._pauses.values()) end();
  }

  /** Steps of this tab before its reload, else those of the tab that was closed or crashed last. */
  takeHistory() {
    return this._tried(async ({ database, layer, tab: { name, alive } }) => {
      const records = await database.ofLayer(HISTORIES, layer);
      const mine = records.find(({ tab }) => tab === name);
      const left = records.filter(({ tab }) => tab !== name && !alive.has(tab));
      await Promise.all(left.map(({ tab }) => database.delete(HISTORIES, [layer, tab])));
      return mine ?? left.sort((one, other) => other.at - one.at)[0];
    });
  }

  /** @param {string[]} keys */
  writeDismissed(keys) {
    this._queue("dismissed", ({ database, layer }) => database.put(DISMISSED, { layer, keys }));
  }

  async readDismissed() {
    return (await this._tried(({ database, layer }) => database.get(DISMISSED, layer)))?.keys ?? [];
  }

  /** @param {Open} open @param {number} frame @param {FrameRecord|null} value */
  async _replace({ database, layer, tab }, frame, value) {
    /** @type {[string, string, number]} */
    const own = [layer, tab.name, frame];
    const gone = this._takenOver.get(frame) ?? [];
    await database.replace(FRAMES, value, value ? gone : [own, ...gone]);
    this._takenOver.set(
      frame,
      (this._takenOver.get(frame) ?? []).filter((key) => !gone.includes(key)),
    );
  }

  /**
   * A database that cannot be read keeps nobody from working.
   * @template Result @param {(open: Open) => Promise<Result>} work @returns {Promise<Result|undefined>}
   */
  async _tried(work) {
    const open = this._open;
    if (!open) return undefined;
    try {
      return await work(open);
    } catch (error) {
      console.warn("the journal could not be read", error);
      return undefined;
    }
  }

  /** @param {string} name @param {(open: Open) => Promise<unknown>} work @param {number} [pause] */
  _queue(name, work, pause = 0) {
    const open = this._open;
    if (!open) return;
    this._waiting.set(name, () => work(open));
    if (!this._writing.has(name)) this._drain(name, pause);
  }

  /** @param {string} name @param {number} pause */
  async _drain(name, pause) {
    this._writing.add(name);
    await Promise.resolve(); // after the whole edit, also when it touches a frame several times
    for (let work = this._waiting.get(name); work; work = this._waiting.get(name)) {
      this._waiting.delete(name);
      try {
        await work();
        this._failed = false;
      } catch (error) {
        this._failed = true;
        console.warn("the journal could not be written", error);
      }
      if (pause) await this._pause(name, pause);
    }
    this._writing.delete(name);
  }

  /** @param {string} name @param {number} pause */
  async _pause(name, pause) {
    await new Promise((resolve) => {
      const end = () => resolve(undefined);
      this._pauses.set(name, end);
      setTimeout(end, pause);
    });
    this._pauses.delete(name);
  }
}
