import { gettext } from "../../base/messages.js";

/**
 * A warning as a sentence.
 * @param {import("../../truth/plausibility.js").Warning} warning
 */
export function warningWords({ kind, persons, value }) {
  const [person, other] = persons;
  const words = {
    close: () => gettext("{person} and {other} are {metres} m apart", { person, other, metres: value.toFixed(2) }),
    fast: () => gettext("{person} comes here at {speed} m/s", { person, speed: value.toFixed(1) }),
    renumbered: () =>
      gettext("{person} vanishes, {other} appears {metres} m away", { person, other, metres: value.toFixed(2) }),
  };
  return words[kind]();
}
