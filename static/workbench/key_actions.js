import { fetchedDialog } from "../base/lazy.js";
import { gettext } from "../base/messages.js";
import { saveWords } from "../saving/save_words.js";

/**
 * @typedef {object} Parts
 * @property {import("../truth/store.js").Store} store
 * @property {import("../saving/saver.js").Saver} saver
 * @property {import("./settings.js").Settings} settings
 * @property {import("../views/panes.js").Panes} panes
 * @property {import("../base/notices.js").Notices} notices
 * @property {import("./frames/navigation.js").Navigation} navigation
 * @property {import("./placing/guard.js").Guard} guard
 * @property {import("./placing/heads.js").Heads} heads
 * @property {import("./placing/dragging.js").Dragging} dragging
 * @property {import("../views/intents.js").Intents} intents what a click means, for keys that do the same
 * @property {import("../views/pointer.js").Pointer} pointer
 * @property {(on: boolean) => void} setControls
 */

/** What keys and buttons do that no other topic does: frames, zoom, display, dialogs, the way out. */
export class KeyActions {
  /** @param {Parts} parts */
  constructor(parts) {
    this._store = parts.store;
    this._saver = parts.saver;
    this._settings = parts.settings;
    this._panes = parts.panes;
    this._notices = parts.notices;
    this._navigation = parts.navigation;
    this._guard = parts.guard;
    this._heads = parts.heads;
    this._dragging = parts.dragging;
    this._intents = parts.intents;
    this._pointer = parts.pointer;
    this._setControls = parts.setControls;
    const { notices } = parts;
    /** @type {() => Promise<typeof import("./keys/help.js")|null>} */
    this._help = fetchedDialog(notices, import.meta.resolve("./keys/help.js"));
    /** @type {() => Promise<typeof import("./settings_dialog.js")|null>} */
    this._settingsDialog = fetchedDialog(notices, import.meta.resolve("./settings_dialog.js"));
  }

  /**
   * Rows for the table of actions, by the ids of the key table.
   * @returns {import("./actions.js").ActionTable}
   */
  table() {
    return {
      moveHere: () => this._moveUnderPointer(),
      heads: () => this._heads.toggle(),
      nextFrame: () => this._navigation.next(),
      previousFrame: () => this._navigation.previous(),
      reload: () => this._navigation.reload(),
      save: () => this._save(),
      zoom: () => this._toggleZoom(),
      outline: () => this._toggle("outline"),
      grid: () => this._toggle("grid"),
      directions: () => this._toggle("directions"),
      help: async () => (await this._help())?.showHelp(this._settings),
      settings: async () => (await this._settingsDialog())?.showSettings(this._settings),
      controls: () => this._setControls(true),
      escape: () => this.escape(),
    };
  }

  escape() {
    this._setControls(false);
    if (this._dragging.cancel()) return;
    if (this._heads.active) return this._heads.toggle(false);
    if (this._panes.zoomed) return this._panes.zoom(false);
    this._store.select(null);
  }

  /** What a right click does, by a key. */
  _moveUnderPointer() {
    if (this._dragging.active) return;
    const under = this._pointer.under();
    if (!under) return this._notices.say(gettext("Point at the feet in one of the views"));
    this._intents.moveHere(under.pane, under.at, under.event);
  }

  /** @param {import("./settings.js").Switch} name */
  _toggle(name) {
    this._settings.set(name, !this._settings.get(name));
  }

  async _save() {
    const saved = await this._saver.flush();
    this._notices.say(saved ? gettext("Everything is saved") : saveWords(this._saver.status(), 0).text);
  }

  _toggleZoom() {
    if (!this._panes.zoomed && !this._store.selected()) return this._guard.sayNobodySelected();
    this._panes.zoom(!this._panes.zoomed);
  }
}
