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
import { element } from "../../base/dom.js";
import { Sheet } from "./sheet.js";
import { SheetActions } from "./sheet_actions.js";

/** @param {Session} session @param {Page} page @returns {Promise<SheetActions>} */
export async function startSheet(session, page) {
  const [proposing] = await Promise.all([page.proposing, styled()]);
  const { proposals, snapping } = proposing ?? { proposals: null, snapping: null };
  const sheet = new Sheet({ ...session, ...page, proposals });
  const acting = new SheetActions({ ...session, ...page, sheet, proposals, snapping });
  around(page.actions, acting.table());
  page.actions.use({ sheet: () => acting.toggle() }); // at once, now that it is here
  return acting;
}

/**
 * Rows that mean something else at times: each is given what the row did before.
 * @param {import("../actions.js").Actions} actions @param {Record<string, import("./sheet_actions.js").Row>} table
 */
function around(actions, table) {
  const rows = Object.entries(table).map(([id, row]) => [
    id,
    /** @param {KeyboardEvent|null} event */
    (event) => row(() => before[id]?.(event), event),
  ]);
  const before = actions.use(Object.fromEntries(rows));
}

/** Nobody who never opens the sheet fetches how it looks. @returns {Promise<unknown>} */
function styled() {
  const href = new URL("./sheet.css", import.meta.url).href;
  return new Promise((done) => {
    document.head.append(element("link", { rel: "stylesheet", href, onload: done, onerror: done }));
  });
}
