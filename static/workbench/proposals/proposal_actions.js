/**
 * @typedef {import("../../base/answers.js").Proposed} Proposed
 * @typedef {import("../../views/pane.js").Pane} Pane
 * @typedef {import("../../views/pane.js").LaidOutPane} LaidOutPane
 * @typedef {import("../../views/pointer.js").Under} Under
 * @typedef {import("../../views/regions.js").XY} XY
 * @typedef {object} Parts
 * @property {import("./proposals.js").Proposals} proposals
 * @property {import("../../truth/store.js").Store} store
 * @property {import("../../views/panes.js").Panes} panes
 * @property {import("../../base/notices.js").Notices} notices
 * @property {() => boolean} refused says why nothing can be changed, if so
 * @property {() => void} round begins the close-up round
 */
import { gettext, ngettext } from "../../base/messages.js";
import { keyFor } from "../keys/keys.js";
import { evidenceItem, nearestFoot, proposalAt, proposalItems } from "./proposal_marks.js";

/** Keys and the pointer over proposals. */
export class ProposalActions {
  /** @param {Parts} parts */
  constructor({ proposals, store, panes, notices, refused, round }) {
    this._proposals = proposals;
    this._store = store;
    this._panes = panes;
    this._notices = notices;
    this._refused = refused;
    this._round = round;
    /** @type {{one: Proposed, pane: Pane, at: XY}|null} under the pointer */
    this._over = null;
    panes.addExtra((pane) => [...proposalItems(proposals, pane), ...this._evidence(pane)]);
    proposals.on("change", () => {
      if (this._over && !proposals.open.includes(this._over.one)) this._over = null;
      panes.markPeople();
    });
    store.on("frame", () => (this._over = null));
  }

  /** Rows for the table of actions, by the ids of the key table. */
  table() {
    return {
      acceptAll: () => this.acceptAll(),
      acceptOne: () => this._withOne((one) => this._proposals.accept([one])),
      refuseOne: () => this._withOne((one) => this._refuse(one)),
      nextProposal: () => this.next(),
      doubtful: () => this.goRound(),
    };
  }

  acceptAll() {
    const chosen = this._proposals.likely;
    if (this._refused()) return;
    if (!chosen.length) return this._notices.say(this._nothingLeft());
    this._proposals.accept(chosen);
    const left = this._proposals.doubtful.length;
    const done = ngettext("{n} proposal accepted", "{n} proposals accepted", chosen.length);
    this._notices.say(left ? `${done}. ${this._nothingLeft()}` : done);
  }

  _nothingLeft() {
    const left = this._proposals.doubtful.length;
    if (!left) return gettext("Nobody is proposed in this frame any more");
    const words = ngettext("{n} doubtful proposal is left", "{n} doubtful proposals are left", left);
    return gettext("{words}: {key} goes through them one by one", { words, key: keyFor("doubtful") });
  }

  next() {
    const { open, focus } = this._proposals;
    if (!open.length) return this._notices.say(this._nothingLeft());
    this._proposals.look(open[(focus ? open.indexOf(focus) + 1 : 0) % open.length]);
  }

  /** Close up, the most doubtful first: they become yellow people, whom Enter validates and Delete refuses. */
  goRound() {
    const chosen = this._proposals.doubtful;
    if (this._refused()) return;
    if (!chosen.length) return this._notices.say(this._nothingLeft());
    this._proposals.takeUp(chosen);
    this._store.select(null);
    if (!this._panes.closeUp) this._round();
  }

  /**
   * A click on the feet of somebody proposed takes them as they are proposed.
   * @param {Pane} pane @param {XY} at @returns {boolean}
   */
  take(pane, at) {
    const one = pane.transform && nearestFoot(this._proposals.open, /** @type {LaidOutPane} */ (pane), at);
    if (!one || this._refused()) return false;
    this._proposals.accept([one]);
    return true;
  }

  /** @param {Pane} pane @param {XY} at CSS pixels */
  hover(pane, at) {
    const one = pane.transform ? proposalAt(this._proposals.open, /** @type {LaidOutPane} */ (pane), at) : null;
    if (one === null && this._over === null) return;
    this._over = one && { one, pane, at };
    this._panes.markPeople();
  }

  leave() {
    if (this._over) this._panes.markPeople();
    this._over = null;
  }

  /** @param {Pane} pane */
  _evidence(pane) {
    if (this._over?.pane !== pane || !pane.transform) return [];
    const { one, at } = this._over;
    return [evidenceItem(one, this._proposals.personOf(one), /** @type {LaidOutPane} */ (pane), at)];
  }

  /** @param {(one: Proposed) => void} act on the one under the pointer, else the one gone to */
  _withOne(act) {
    const one = this._over?.one ?? this._proposals.focus;
    if (this._refused()) return;
    if (one) return act(one);
    this._notices.say(gettext("Point at a proposal, or go to the next one: {key}", { key: keyFor("nextProposal") }));
  }

  /** @param {Proposed} one */
  _refuse(one) {
    const { open } = this._proposals;
    const following = open[open.indexOf(one) + 1] ?? null;
    const focused = this._proposals.focus === one;
    this._proposals.refuse(one);
    if (focused) this._proposals.look(following);
    this._notices.say(gettext("Nobody there – {key} brings the proposal back", { key: keyFor("undo") }));
  }
}
