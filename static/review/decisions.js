import { ask } from "../base/dialogs.js";
import { fetchedDialog } from "../base/lazy.js";
import { gettext, ngettext } from "../base/messages.js";

/**
 * What the reviewer decides, and where the desk goes then: to the next batch that waits.
 * @typedef {import("../base/notices.js").Notices} Notices
 * @typedef {import("./desk.js").Desk} Desk
 * @typedef {{desk: Desk, store: import("./store.js").DeskStore, server: import("./server.js").DeskServer,
 *            notices: Notices, comments: import("./comments.js").CommentList, names: {found: string}}} Parts
 */
export class Decisions {
  /** @param {Parts} parts */
  constructor(parts) {
    this._parts = parts;
    this._busy = false;
    /** @type {() => Promise<typeof import("./dialogs.js")|null>} */
    this._dialogs = fetchedDialog(parts.notices, import.meta.resolve("./dialogs.js"));
  }

  /** Differences that nobody looked at are asked about; without any, one key is enough. */
  async accept() {
    const { store } = this._parts;
    if (store.unseen > 0) {
      const title = ngettext(
        "{n} difference was not looked at. Accept all the same?",
        "{n} differences were not looked at. Accept all the same?",
        store.unseen,
      );
      const buttons = [
        { id: "look", label: gettext("Look at them"), main: true },
        { id: "accept", label: gettext("Accept") },
      ];
      const answer = await ask({ title, body: [], buttons });
      if (answer === "look") store.step(1);
      if (answer !== "accept") return;
    }
    await this._decide("accept");
  }

  async acceptMended() {
    await this._decide("accept_mended");
  }

  async giveBack() {
    const dialogs = await this._dialogs();
    const open = (this._parts.comments.comments ?? []).filter(({ resolved }) => !resolved).length;
    const written = await dialogs?.write({
      title: gettext("Return to the worker"),
      body: [ngettext("{n} open comment goes with it.", "{n} open comments go with it.", open)],
      label: open ? gettext("A word to it, if you like") : gettext("What has to be put right?"),
      send: gettext("Return"),
      least: open ? 0 : 1,
    });
    if (written) await this._decide("return", { reason: written.text });
  }

  async reject() {
    const { desk } = this._parts;
    const dialogs = await this._dialogs();
    const written = await dialogs?.write({
      title: gettext("Reject the batch"),
      body: [gettext("The worker reads the reason and may appeal once. Somebody else gets the batch.")],
      label: gettext("Reason"),
      send: gettext("Reject"),
      least: desk.least,
      categories: desk.categories,
    });
    if (written) await this._decide("reject", { reason: written.text, category: written.category });
  }

  /** The batch becomes free for others. */
  async takeBack() {
    const dialogs = await this._dialogs();
    const written = await dialogs?.write({
      title: gettext("Take the batch back"),
      body: [gettext("Its worker did not come back to it: somebody else may have it.")],
      label: gettext("Reason"),
      send: gettext("Take back"),
      least: 1,
    });
    if (written) await this._decide("take_back", { reason: written.text });
  }

  /** Pinned to the frame, and to whoever is chosen. */
  async comment() {
    const { store, server, comments, notices } = this._parts;
    const { current, chosen } = store;
    const place = chosen?.found ?? chosen?.truth ?? null;
    const person = chosen?.found?.person ?? null;
    const dialogs = await this._dialogs();
    const written = await dialogs?.write({
      title: gettext("Comment"),
      body: [pinWords(store.ordinal(current), person, place !== null)],
      label: gettext("What the worker should do"),
      send: gettext("Comment"),
      least: 1,
    });
    if (!written) return;
    try {
      const pin = { frame: current, person, position: place?.position ?? null };
      comments.show((await server.comment(written.text, pin)).comments);
    } catch (error) {
      notices.say(error instanceof Error ? error.message : String(error));
    }
  }

  /** @param {string} action @param {{reason?: string, category?: string}} [more] */
  async _decide(action, more) {
    const { server, notices, desk } = this._parts;
    if (this._busy) return;
    this._busy = true;
    try {
      const { next } = await server.decide(action, more);
      window.location.assign(next === null ? desk.home : desk.desk.replace(/\/0\/$/, `/${next}/`));
    } catch (error) {
      this._busy = false;
      notices.say(error instanceof Error ? error.message : String(error));
    }
  }
}

/** @param {number} frame @param {number|null} person @param {boolean} placed */
function pinWords(frame, person, placed) {
  if (person !== null) return gettext("Frame {frame}, person {person}", { frame, person });
  return placed ? gettext("Frame {frame}, this place", { frame }) : gettext("Frame {frame}", { frame });
}
