import { ApiError, messageOf, NetworkError } from "./api.js";
import { gettext } from "./messages.js";

/**
 * Why the server's answer is not there, to be put into a sentence. Anything else than that is a fault of ours.
 * @param {unknown} error
 */
export function failureWords(error) {
  if (error instanceof NetworkError) return gettext("the server does not answer");
  if (!(error instanceof ApiError)) throw error;
  if (error.signedOut) return gettext("you are signed out");
  if (error.code === "unknown" || error.code === "unreadable") return gettext("the server does not answer properly");
  return error.message;
}

/**
 * The same for what can fail in other ways too, as a picture that cannot be decoded.
 * @param {unknown} error
 */
export function problemWords(error) {
  const ours = error instanceof NetworkError || error instanceof ApiError;
  return ours ? failureWords(error) : messageOf(error);
}
