import { gettext, ngettext } from "../base/messages.js";

/**
 * The saved state in words. @returns {{text: string, link?: string}} `link`: the part to press, if any
 * @param {import("./save_status.js").Status} status @param {number|null} revision @param {boolean} [tutorial]
 */
export function saveWords(status, revision, tutorial = false) {
  if (tutorial) return { text: gettext("Tutorial – nothing has to be saved") };
  const n = status.unsaved;
  switch (status.kind) {
    case "saved":
      return { text: revision ? gettext("All saved · r{revision}", { revision }) : gettext("All saved") };
    case "saving":
      return { text: gettext("Saving…") };
    case "offline":
      return { text: gettext("Offline – {edits}", { edits: kept(status) }) };
    case "server":
      return { text: gettext("The server does not answer properly – {edits}, trying again", { edits: kept(status) }) };
    case "signed_out":
      return {
        text: gettext("Signed out – {edits}, nothing is lost.", { edits: kept(status) }),
        link: gettext("Open sign-in in a new tab"),
      };
    case "conflict":
      return { text: gettext("Changed in two places – please decide") };
    case "refused":
      return { text: gettext("Not saved: {reason}", { reason: status.reason }) };
    case "read_only":
      return n
        ? {
            text: gettext("Read-only: {reason} ({edits})", {
              reason: status.reason,
              edits: kept({ ...status, kept: true }),
            }),
          }
        : { text: gettext("Read-only: {reason}", { reason: status.reason }) };
    default:
      throw new RangeError(`unknown save state ${/** @type {{kind: string}} */ (status).kind}`);
  }
}

/** @param {{unsaved: number, kept: boolean}} status */
function kept({ unsaved, kept: durable }) {
  return durable
    ? ngettext("{n} edit kept on this computer", "{n} edits kept on this computer", unsaved)
    : ngettext(
        "{n} edit waiting in this window: keep it open",
        "{n} edits waiting in this window: keep it open",
        unsaved,
      );
}
