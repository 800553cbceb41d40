import { NetworkError } from "./api.js";
import { gettext } from "./messages.js";

/** Make sure frames of a long layer are there. @returns {Promise<boolean>} false: said that they could not be loaded */
export async function loadMissing({ store, loader, notices }, numbers) {
  const missing = numbers.filter((number) => !store.frame(number).loaded);
  try {
    await loader.loadAll(missing);
    return true;
  } catch (error) {
    if (!(error instanceof NetworkError)) throw error;
    notices.say(gettext("Not possible now: the other frames could not be loaded"));
    return false;
  }
}
