/** Asking the server to save, and what a failure tells: whether to try again, what to merge with, what to say. */
import { ApiError, NetworkError } from "../base/api.js";

/**
 * @typedef {import("../base/answers.js").FrameAnswer} FrameAnswer
 * @typedef {import("../base/answers.js").SaveBody} SaveBody
 * @typedef {{keepalive?: boolean}} SendOptions
 * @typedef {"offline"|"server"|"signed_out"} Trouble it may go away by itself
 */

/**
 * The server's receipt, or why there is none; never rejects.
 * @param {Pick<import("../base/api.js").Api, "saveFrame">} api @param {number} frame @param {SaveBody} body
 * @param {SendOptions} options
 * @returns {Promise<{answer: FrameAnswer}|{error: unknown}>}
 */
export async function saved(api, frame, body, options) {
  try {
    const answer = await api.saveFrame(frame, body, options);
    if (Number.isInteger(answer?.revision)) return { answer };
    return { error: new ApiError(200, "unreadable", "the answer is no receipt") }; // somebody else's, on the way
  } catch (error) {
    return { error };
  }
}

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
