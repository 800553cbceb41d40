/**
 * How edits are kept at the moment: one answer for all frames, the most pressing one.
 * @typedef {import("./save_failures.js").Trouble} Trouble
 * @typedef {{kind: "saved"|"saving"|"conflict", unsaved: number}
 *          |{kind: Trouble, unsaved: number, kept: boolean}
 *          |{kind: "refused"|"read_only", reason: string, unsaved: number}} Status `kept`: they survive a crash
 * @param {import("./edit_record.js").Slot[]} slots
 * @param {{unsaved: number, trouble: Trouble|null, readOnly: string|null, kept: boolean}} saver
 * @returns {Status}
 */
export function statusOf(slots, { unsaved, trouble, readOnly, kept }) {
  if (readOnly !== null) return { kind: "read_only", reason: readOnly, unsaved };
  if (slots.some((slot) => slot.question)) return { kind: "conflict", unsaved };
  const refused = slots.find((slot) => slot.refused)?.refused;
  if (refused) return { kind: "refused", reason: refused, unsaved };
  if (trouble) return { kind: trouble, unsaved, kept };
  return { kind: unsaved ? "saving" : "saved", unsaved };
}
