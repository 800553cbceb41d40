import { NetworkError } from "./api.js";
import { gettext } from "./messages.js";

/** Why something did not arrive, for people: what browsers say of a lost connection ("Failed to fetch") tells nobody anything. */
export function problemWords(error) {
  const lost = error instanceof NetworkError || (error instanceof TypeError && /fetch|network|load failed/i.test(error.message));
  return lost ? gettext("no connection") : error.message;
}
