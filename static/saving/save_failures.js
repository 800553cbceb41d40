/** What a save that failed tells: whether to try again, what to merge with, what to say. */
import { ApiError, NetworkError } from "../base/api.js";

/** @typedef {"offline"|"server"|"signed_out"} Trouble it may go away by itself */

/**
 * @returns {"signed_out"|"offline"|"server"}
 * @param {unknown} error
 */
export function troubleOf(error) {
  if (error instanceof NetworkError) return "offline";
  if (error instanceof ApiError) return error.signedOut ? "signed_out" : "server";
  console.error(error); // nobody foresaw it: tried again, less and less often, like everything else
  return "server";
}

/** The frame as it is now: a stale save is refused with it. @param {ApiError} error */
export function currentOf({ details, message }) {
  const current = details && !Array.isArray(details) ? details.current : undefined;
  if (!current) throw new TypeError(`a refusal without the newer frame: ${message}`);
  return current;
}

/** @param {ApiError} error */
export function refusalWords({ details, message }) {
  const places = Array.isArray(details) ? details.map(({ place, reason }) => `${place}: ${reason}`) : [];
  return places.length ? places.join("; ") : message;
}
