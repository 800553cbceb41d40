import { DISMISSED, FRAMES, HISTORIES, openDatabase } from "./database.js";
import { joinTabs, shareNumbers } from "./tabs.js";

// Between two writes of one record while a key is held, ms. Undo steps are worth less than what is annotated.
const PAUSE = 300;
const PAUSE_OF_HISTORY = 1000;

/**
 * Keeps what the server has not acknowledged, so that a crash, a closed lid or an expired session loses nothing.
 * Writing never blocks an edit: one write at a time per record, always of the newest value. The first edit is
 * written at once, those of a burst a moment later together: each write copies the whole record.
 */
export class Journal {
  /** @param {string} layer whose edits; null: nothing is kept (tutorial) */
  static async open(layer) {
    if (layer === null) return new Journal(layer, null, null);
    try {
      const [database, tab] = await Promise.all([openDatabase(), joinTabs(layer)]);
      return new Journal(layer, database, tab);
    } catch (error) {
      console.warn("edits cannot be kept in this browser", error);
      return new Journal(layer, null, null);
    }
  }

  constructor(layer, database, tab) {
    this._layer = layer;
    this._database = database;
    this._tab = tab;
    this._waiting = new Map();
    this._writing = new Set();
    this._urgent = new Set(); // records that must not wait for the end of their pause
    this._pauses = new Map(); // record → ends its pause
  }

  /** Whether edits survive a crash in this browser. */
  get keeps() {
    return this._database !== null;
  }

  /** From now on this tab and the others of the layer give away different person numbers. */
  shareNumbers(store) {
    if (this.keeps) shareNumbers(this._tab, store);
  }

  /**
   * @param {() => object} record made when it is written, so that a burst of edits costs one write
   * @param {boolean} patient one edit of many: it may wait a moment
   */
  write(frame, record, patient = false) {
    const work = () => this._database.put(FRAMES, { ...record(), layer: this._layer, tab: this._tab.name, frame });
    this._queue(`frame ${frame}`, work, patient);
  }

  clear(frame) {
    this._queue(`frame ${frame}`, () => this._database.delete(FRAMES, [this._layer, this._tab.name, frame]));
  }

  /** Edits of this tab before its reload, and of tabs that are gone; oldest first. */
  async recover() {
    if (!this.keeps) return [];
    const records = await this._database.ofLayer(FRAMES, this._layer);
    const mine = records.filter(({ tab }) => tab === this._tab.name || !this._tab.alive.has(tab));
    return mine.sort((one, other) => one.at - other.at);
  }

  /** An adopted record of another tab now lives under this tab's name. */
  async drop(record) {
    if (record.tab !== this._tab.name) await this._database.delete(FRAMES, [record.layer, record.tab, record.frame]);
  }

  writeHistory(dump) {
    const work = () => this._database.put(HISTORIES, { layer: this._layer, tab: this._tab.name, at: Date.now(), ...dump() });
    this._queue("history", work, true);
  }

  /** Write what waits: the page goes away. */
  hurry() {
    for (const end of this._pauses.values()) end();
  }

  /** Steps of this tab before its reload, else those of the tab that was closed or crashed last. */
  async takeHistory() {
    if (!this.keeps) return undefined;
    const records = await this._database.ofLayer(HISTORIES, this._layer);
    const mine = records.find(({ tab }) => tab === this._tab.name);
    const left = records.filter(({ tab }) => tab !== this._tab.name && !this._tab.alive.has(tab));
    await Promise.all(left.map(({ layer, tab }) => this._database.delete(HISTORIES, [layer, tab])));
    return mine ?? left.sort((one, other) => other.at - one.at)[0];
  }

  writeDismissed(keys) {
    this._queue("dismissed", () => this._database.put(DISMISSED, { layer: this._layer, keys }));
  }

  async readDismissed() {
    return this.keeps ? ((await this._database.get(DISMISSED, this._layer))?.keys ?? []) : [];
  }

  _queue(name, work, patient = false) {
    if (!this.keeps) return;
    this._waiting.set(name, work);
    if (!patient) {
      this._urgent.add(name);
      this._pauses.get(name)?.();
    }
    if (!this._writing.has(name)) this._drain(name);
  }

  async _drain(name) {
    this._writing.add(name);
    await Promise.resolve(); // after the whole edit, also when it touches a frame several times
    while (this._waiting.has(name)) {
      const work = this._waiting.get(name);
      this._waiting.delete(name);
      this._urgent.delete(name);
      try {
        await work();
      } catch (error) {
        console.warn("the journal could not be written", error);
      }
      if (!this._urgent.has(name)) await this._pause(name);
    }
    this._writing.delete(name);
  }

  async _pause(name) {
    await new Promise((resolve) => {
      this._pauses.set(name, resolve);
      setTimeout(resolve, name === "history" ? PAUSE_OF_HISTORY : PAUSE);
    });
    this._pauses.delete(name);
  }
}
