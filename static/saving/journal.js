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
   * @param {string} layer whose edits: a name no other layer has, on no server; null: nothing is kept (tutorial)
   * @param {string|null} formerly its name in earlier versions, which layers of other databases may have, too
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

  constructor(layer, database, tab, formerly = null) {
    this._layer = layer;
    this._formerly = formerly;
    this._database = database;
    this._tab = tab;
    this._failed = false; // the last write, for want of room for instance
    this._takenOver = new Map(); // frame → keys of records that the next write of the frame replaces
    this._waiting = new Map();
    this._writing = new Set();
    this._pauses = new Map(); // record → ends its pause
  }

  /** Whether edits survive a crash in this browser. */
  get keeps() {
    return this._isOpen && !this._failed;
  }

  get _isOpen() {
    return this._database?.isOpen ?? false;
  }

  /** From now on this tab and the others of the layer give away different person numbers. */
  shareNumbers(store) {
    if (this.keeps) shareNumbers(this._tab, store);
  }

  /**
   * @param {() => object} record made when it is written, so that a burst of edits costs one write
   */
  write(frame, record) {
    const value = () => ({ ...record(), layer: this._layer, tab: this._tab.name, frame });
    this._queue(`frame ${frame}`, () => this._replace(frame, value()));
  }

  clear(frame) {
    this._queue(`frame ${frame}`, () => this._replace(frame, null));
  }

  /**
   * Edits of this tab before its reload, and of tabs that are gone; oldest first. `formerly`: kept under the
   * name of earlier versions, so they may be another layer's.
   */
  async recover() {
    const records = await this._tried(async () => [
      ...(await this._database.ofLayer(FRAMES, this._layer)),
      ...(this._formerly === null ? [] : await this._database.ofLayer(FRAMES, this._formerly)).map((one) => ({
        ...one,
        formerly: true,
      })),
    ]);
    const mine = (records ?? []).filter(({ tab }) => tab === this._tab.name || !this._tab.alive.has(tab));
    return mine.sort((one, other) => one.at - other.at);
  }

  /** From its next write on, this tab's record of the frame stands for this one as well: never both, never none. */
  takeOver({ layer, tab, frame }) {
    if (!this._isOpen || (layer === this._layer && tab === this._tab.name)) return;
    this._takenOver.set(frame, [...(this._takenOver.get(frame) ?? []), [layer, tab, frame]]);
  }

  writeHistory(dump) {
    const work = () =>
      this._database.put(HISTORIES, { layer: this._layer, tab: this._tab.name, at: Date.now(), ...dump() });
    this._queue("history", work, PAUSE_OF_HISTORY);
  }

  /** Write what waits: the page goes away. */
  hurry() {
    for (const end of this._pauses.values()) end();
  }

  /** Steps of this tab before its reload, else those of the tab that was closed or crashed last. */
  takeHistory() {
    return this._tried(async () => {
      const records = await this._database.ofLayer(HISTORIES, this._layer);
      const mine = records.find(({ tab }) => tab === this._tab.name);
      const left = records.filter(({ tab }) => tab !== this._tab.name && !this._tab.alive.has(tab));
      await Promise.all(left.map(({ layer, tab }) => this._database.delete(HISTORIES, [layer, tab])));
      return mine ?? left.sort((one, other) => other.at - one.at)[0];
    });
  }

  writeDismissed(keys) {
    this._queue("dismissed", () => this._database.put(DISMISSED, { layer: this._layer, keys }));
  }

  async readDismissed() {
    return (await this._tried(() => this._database.get(DISMISSED, this._layer)))?.keys ?? [];
  }

  async _replace(frame, value) {
    const own = [this._layer, this._tab.name, frame];
    const gone = this._takenOver.get(frame) ?? [];
    await this._database.replace(FRAMES, value, value ? gone : [own, ...gone]);
    this._takenOver.set(
      frame,
      (this._takenOver.get(frame) ?? []).filter((key) => !gone.includes(key)),
    );
  }

  /** A database that cannot be read keeps nobody from working. */
  async _tried(work) {
    if (!this._isOpen) return undefined;
    try {
      return await work();
    } catch (error) {
      console.warn("the journal could not be read", error);
      return undefined;
    }
  }

  _queue(name, work, pause = 0) {
    if (!this._isOpen) return;
    this._waiting.set(name, work);
    if (!this._writing.has(name)) this._drain(name, pause);
  }

  async _drain(name, pause) {
    this._writing.add(name);
    await Promise.resolve(); // after the whole edit, also when it touches a frame several times
    while (this._waiting.has(name)) {
      const work = this._waiting.get(name);
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

  async _pause(name, pause) {
    await new Promise((resolve) => {
      this._pauses.set(name, resolve);
      setTimeout(resolve, pause);
    });
    this._pauses.delete(name);
  }
}
