/**
 * The part itself, fetched when somebody first wants to see everybody side by side.
 * @typedef {import("../../saving/session.js").Session} Session
 * @typedef {object} Page
 * @property {import("../../views/panes.js").Panes} panes
 * @property {import("../../base/notices.js").Notices} notices
 * @property {import("../frames/navigation.js").Navigation} navigation
 * @property {import("../placing/guard.js").Guard} guard
 * @property {import("../actions.js").Actions} actions
 * @property {(id: string) => void} perform
 * @property {Promise<{proposals: import("./sheet.js").Proposals & import("./sheet_edits.js").Proposing,
 *            snapping: {settle: (person: number) => unknown}}|null>} proposing null: nobody is proposed here
 */
import { Sheet } from "./sheet.js";
import { SheetActions } from "./sheet_actions.js";

/** @param {Session} session @param {Page} page @returns {Promise<SheetActions>} */
export async function startSheet(session, page) {
  const proposing = await page.proposing;
  const { proposals, snapping } = proposing ?? { proposals: null, snapping: null };
  const sheet = new Sheet({ ...session, ...page, proposals });
  const acting = new SheetActions({ ...session, ...page, sheet, proposals, snapping });
  page.actions.around(acting.table());
  page.actions.use({ sheet: () => acting.toggle() }); // at once, now that it is here
  return acting;
}
