import { fetchedDialog } from "../../base/lazy.js";
import { gettext, ngettext } from "../../base/messages.js";
import { loadMissing } from "../../saving/load_missing.js";
import { keyFor } from "../keys/keys.js";

/**
 * What an annotator does about who is who. Every row shows what it will change, then runs one command.
 * @typedef {import("../../truth/commands.js").Patch} Patch
 * @typedef {import("../../truth/identity.js").Choice} Choice
 * @typedef {typeof import("./identity_dialog.js")} DialogPart
 */
export class IdentityActions {
  /**
   * @param {object} parts
   * @param {import("../../truth/scene.js").Scene} parts.scene
   * @param {import("../../truth/store.js").Store} parts.store
   * @param {import("../../truth/history.js").History} parts.history
   * @param {import("../../saving/loader.js").Loader} parts.loader
   * @param {import("../../views/panes.js").Panes} parts.panes
   * @param {import("../../base/notices.js").Notices} parts.notices
   * @param {import("../placing/guard.js").Guard} parts.guard
   */
  constructor({ scene, store, history, loader, panes, notices, guard }) {
    this.scene = scene;
    this.store = store;
    this.history = history;
    this.loader = loader;
    this.panes = panes;
    this.notices = notices;
    this.guard = guard;
    /** @type {() => Promise<DialogPart|null>} */
    this._dialog = fetchedDialog(notices, import.meta.resolve("./identity_dialog.js"));
    this._asking = false;
  }

  /** Rows for the table of actions, by the ids of the key table. */
  table() {
    return {
      rename: () => this.ask({ kind: "rename" }),
      split: () => this.ask({ kind: "split" }),
      join: () => this.ask({ kind: "join" }),
      swap: () => this.ask({ kind: "swap" }),
      removeMore: () => this.ask({ kind: "remove", scope: "onwards" }),
    };
  }

  /** @param {Partial<Choice> & Pick<Choice, "kind">} start without a person: about the selected one */
  async ask(start) {
    const person = start.person ?? this.guard.selected()?.person;
    if (person === undefined || this.guard.refused() || this._asking) return;
    this._asking = true;
    try {
      const dialog = await this._dialog();
      if (!dialog || !(await this._loadAll())) return;
      const { scene, store, history } = this;
      const patch = await dialog.chooseIdentity(
        { scene, store, history, mapColours: this.panes.options.mapColours },
        { ...start, person },
      );
      if (patch) this._run(patch);
    } finally {
      this._asking = false;
    }
  }

  /** @param {Patch} patch */
  _run(patch) {
    this.history.run(patch);
    const frames = new Set(patch.edits.map(({ frame }) => frame)).size;
    const where = ngettext("in {n} frame", "in {n} frames", frames);
    this.notices.say(
      gettext("Done {where}: {label} – {key} takes all of it back", { where, label: patch.label, key: keyFor("undo") }),
    );
  }

  /** Of a long layer only a piece is there, but a person may be anywhere in it. */
  async _loadAll() {
    const missing = this.store.numbers.filter((number) => !this.store.frame(number).loaded);
    if (!missing.length) return true;
    this.notices.say(ngettext("Loading {n} frame…", "Loading {n} frames…", missing.length));
    return loadMissing(this, missing);
  }
}
