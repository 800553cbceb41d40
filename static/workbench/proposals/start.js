/**
 * The part itself, fetched by pages of frames that somebody is proposed in.
 * @typedef {import("../../saving/session.js").Session} Session
 * @typedef {import("../../truth/store.js").Store} Store
 * @typedef {import("../../views/intents.js").Intents} Intents
 * @typedef {object} Page
 * @property {import("../settings.js").Settings} settings
 * @property {import("../../views/panes.js").Panes} panes
 * @property {import("../../base/notices.js").Notices} notices
 * @property {HTMLElement} panel
 * @property {(id: string) => void} perform
 * @property {import("../placing/guard.js").Guard} guard
 * @property {import("../people/queue.js").Queue} queue
 * @property {import("../actions.js").Actions} actions
 * @property {Intents} intents
 */
import { gettext } from "../../base/messages.js";
import { addKeys } from "../keys/keys.js";
import { ProposalActions } from "./proposal_actions.js";
import { ProposalPanel } from "./proposal_panel.js";
import { Proposals } from "./proposals.js";
import { Snapping, settleAfter } from "./snapping.js";

const STORED = "gtm-workbench-proposalThreshold";

/** @type {Parameters<typeof addKeys>[0]} */
const KEYS = [
  ["acceptAll", "people", ["o"], () => gettext("accept all proposals that are taken for real")],
  ["acceptOne", "people", ["Shift+o"], () => gettext("accept the proposal under the pointer, or gone to")],
  ["refuseOne", "people", ["Shift+r"], () => gettext("refuse it: nobody is there")],
  ["nextProposal", "people", ["Shift+f"], () => gettext("go to the next proposal, the most doubtful first")],
  ["snap", "person", ["Shift+d"], () => gettext("to where the views show somebody, half a metre at most")],
  ["doubtful", "people", ["Shift+a"], () => gettext("one by one, close up, through the doubtful proposals")],
];

/**
 * @param {Session} session @param {Page} page
 * @returns {Promise<{proposals: Proposals, snapping: Snapping}|null>} null: they could not be had
 */
export async function startProposals(session, page) {
  /** @type {import("../../base/answers.js").ProposalsAnswer|null} */
  const answer = await session.api.ask("GET", "proposals/").catch(console.warn);
  if (!answer) return null; // who is proposed is a help, not a condition
  const { panes, notices, panel, perform, guard, settings, actions } = page;
  const proposals = new Proposals(session, answer, stored() ?? answer.threshold);
  const acting = new ProposalActions({
    proposals,
    store: session.store,
    panes,
    notices,
    refused: () => guard.refused(),
    round: () => perform("round"),
  });
  const snapping = new Snapping({ ...session, notices, guard });
  actions.use(acting.table());
  actions.use(snapping.table());
  addKeys(KEYS);
  settings.set("keys", settings.get("keys")); // the keyboard learns them
  settleAfter(page.intents, snapping, session.store);
  listen(page.intents, acting);
  doubtfulFirst(page.queue, session.store, answer);
  panel.append(new ProposalPanel({ proposals, perform, remember }).element);
  return { proposals, snapping };
}

/**
 * The pointer means proposals first: a click on the feet of one takes them, and over one stands what speaks for it.
 * @param {Intents} intents @param {ProposalActions} acting
 */
function listen(intents, acting) {
  const place = intents.place.bind(intents);
  const hover = intents.hover.bind(intents);
  const leave = intents.leave.bind(intents);
  intents.place = (pane, at, event) => acting.take(pane, at) || place(pane, at, event);
  intents.hover = (pane, at, over) => {
    hover(pane, at, over);
    acting.hover(pane, at);
  };
  intents.leave = () => {
    leave();
    acting.leave();
  };
}

/**
 * Of the people still to be looked at those come first whose proposals are most doubtful.
 * @param {import("../people/queue.js").Queue} queue @param {Store} store
 * @param {import("../../base/answers.js").ProposalsAnswer} answer
 */
function doubtfulFirst(queue, store, { frames }) {
  const doubts = new Map(
    frames.map(({ number, people }) => [number, new Map(people.map(({ position, doubt }) => [position, doubt]))]),
  );
  /** @param {number} person */
  const doubt = (person) => doubts.get(store.current)?.get(store.marked(person).position) ?? 0;
  queue.first = (persons) => {
    const [most] = [...persons].sort((one, other) => doubt(other) - doubt(one));
    return doubt(most) > 0 ? most : undefined;
  };
}

/** @returns {number|null} */
function stored() {
  try {
    const value = Number.parseFloat(window.localStorage.getItem(STORED) ?? "");
    return value >= 0 && value <= 1 ? value : null;
  } catch {
    return null; // storage may be forbidden
  }
}

/** @param {number} threshold */
function remember(threshold) {
  try {
    window.localStorage.setItem(STORED, String(threshold));
  } catch {
    // the choice then lasts for this page only
  }
}
