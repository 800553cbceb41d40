/**
 * The part itself, fetched by pages of frames that somebody is proposed in.
 * @typedef {import("../../saving/session.js").Session} Session
 * @typedef {object} Page
 * @property {import("../../views/panes.js").Panes} panes
 * @property {import("../../base/notices.js").Notices} notices
 * @property {HTMLElement} panel
 * @property {(id: string) => void} perform
 * @property {() => boolean} refused
 * @property {import("../people/queue.js").Queue} queue
 */
import { ProposalActions } from "./proposal_actions.js";
import { ProposalPanel } from "./proposal_panel.js";
import { Proposals } from "./proposals.js";

const STORED = "gtm-workbench-proposalThreshold";

/**
 * @param {Session} session @param {Page} page
 * @returns {Promise<ProposalActions>}
 */
export async function startProposals(session, { panes, notices, panel, perform, refused, queue }) {
  const answer = await session.api.proposals();
  const proposals = new Proposals(session, answer, stored() ?? answer.threshold);
  const actions = new ProposalActions({
    proposals,
    store: session.store,
    panes,
    notices,
    refused,
    round: () => perform("round"),
  });
  const doubts = new Map(answer.frames.flatMap(({ people }) => people).map((one) => [one.position, one.doubt]));
  queue.doubt = ({ position }) => doubts.get(position) ?? 0;
  panel.append(new ProposalPanel({ proposals, perform, remember }).element);
  return actions;
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
