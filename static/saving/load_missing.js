import { failureWords } from "../base/failure_words.js";
import { gettext } from "../base/messages.js";

/** @typedef {import("../base/notices.js").Notices} Notices */

/**
 * Make sure frames of a long layer are there. @returns {Promise<boolean>} false: said that they could not be loaded
 * @param {{store: import("../truth/store.js").Store, loader: import("./loader.js").Loader, notices: Notices}} parts @param {number[]} numbers
 */
export async function loadMissing({ store, loader, notices }, numbers) {
  const missing = numbers.filter((number) => !store.frame(number).loaded);
  try {
    await loader.loadAll(missing);
    return true;
  } catch (error) {
    sayNotLoaded(notices, error);
    return false;
  }
}

/** @param {Notices} notices @param {unknown} error */
function sayNotLoaded(notices, error) {
  notices.say(
    gettext("Not possible now: the other frames could not be loaded, {reason}", { reason: failureWords(error) }),
  );
}
