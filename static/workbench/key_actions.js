import { fetchedDialog } from "../base/lazy.js";
import { gettext } from "../base/messages.js";
import { saveWords } from "../saving/save_words.js";

/** What keys and buttons do that no other topic does: frames, zoom, display, dialogs, the way out. */
export class KeyActions {
  /**
   * @param {{intents: import("../views/intents.js").Intents, pointer: import("../views/pointer.js").Pointer,
   *          setControls: (on: boolean) => void}} parts the pointer's place and meaning are for keys that do what a click does
   */
  constructor({
    store,
    saver,
    settings,
    panes,
    notices,
    navigation,
    guard,
    heads,
    dragging,
    intents,
    pointer,
    setControls,
  }) {
    Object.assign(this, {
      _store: store,
      _saver: saver,
      _settings: settings,
      _panes: panes,
      _notices: notices,
      _navigation: navigation,
    });
    Object.assign(this, {
      _guard: guard,
      _heads: heads,
      _dragging: dragging,
      _intents: intents,
      _pointer: pointer,
      _setControls: setControls,
    });
    this._help = fetchedDialog(notices, import.meta.resolve("./keys/help.js"));
    this._settingsDialog = fetchedDialog(notices, import.meta.resolve("./settings_dialog.js"));
  }

  /** Rows for the table of actions, by the ids of the key table. */
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

  _toggle(name) {
    this._settings.set(name, !this._settings.get(name));
  }

  async _save() {
    const saved = await this._saver.flush();
    this._notices.say(saved ? gettext("Everything is saved") : saveWords(this._saver.status(), null).text);
  }

  _toggleZoom() {
    if (!this._panes.zoomed && !this._store.selected()) return this._guard.sayNobodySelected();
    this._panes.zoom(!this._panes.zoomed);
  }
}
