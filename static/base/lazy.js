import { gettext } from "./messages.js";

const IMPORTED = /\bfrom\s*"(\.[^"]+)"/g;
const BESIDE = 500; // ms after the first action: opening is over, and nobody misses the network
const LEAVING = 600; // ms; a page that is being left stops its requests, but runs no timers any more
const TIMEOUT = 20_000; // ms; whoever waits for a part on a dead connection would wait for ever
const MEANT_FOR_IT = 1000; // ms in which keys pressed after asking for a dialog are not meant for the page
/** @type {Set<string>} addresses of modules that are here */
const present = new Set();
/** @type {Set<string>} addresses */
const parts = new Set();
let dialogs = 0; // under way

/** @typedef {{say: (text: string) => void}} Says as Notices do */

/**
 * A part that few need, fetched when it is needed. Where it does not arrive, the annotator is told and nothing
 * else happens; the next try fetches it again.
 * @template Module
 * @template [Part=Module]
 * @param {Says} notices
 * @param {string} address of its module, from import.meta.resolve
 * @param {(module: Module) => Part} [make] what the part is, the module itself unless it is said; called once
 * @param {(address: string) => Promise<Module>} [loaded]
 * @returns {() => Promise<Part|null>} the part, always the same; null: it did not arrive
 */
export function fetched(notices, address, make = itself, loaded = load) {
  /** @type {Part|null} */
  let part = null;
  if (!parts.size) notePresent();
  parts.add(address);
  return async () => {
    if (part) return part;
    const module = await loaded(address).catch((error) => console.warn("a part did not arrive", error));
    if (!module) {
      await later(LEAVING);
      notices.say(
        gettext("This part of the page did not arrive: the server does not answer. Nothing is lost – please try again"),
      );
    }
    if (!module) return null;
    part ??= make(module);
    return part;
  };
}

/**
 * @template Module, Part
 * @param {Module} module
 */
function itself(module) {
  return /** @type {Part} */ (/** @type {unknown} */ (module));
}

/** Whatever the page itself is made of is here before its first part is spoken of. */
function notePresent() {
  for (const { name } of performance.getEntriesByType("resource")) present.add(name);
}

/**
 * A part that is a dialog: for a moment keys wait for it instead of changing something behind it.
 * @template Module
 * @param {Says} notices @param {string} address
 * @returns {() => Promise<Module|null>}
 */
export function fetchedDialog(notices, address) {
  return fetched(notices, address, undefined, async () => {
    /** @type {Promise<Module>} */
    const module = load(address);
    dialogs += 1;
    await Promise.race([module, later(MEANT_FOR_IT)]).finally(() => (dialogs -= 1));
    return module;
  });
}

export function dialogArrives() {
  return dialogs > 0;
}

/** Fetch all parts beside the work, once somebody works: they open at once then, and without the server. */
export async function fetchParts() {
  await later(BESIDE);
  for (const address of parts) await load(address).catch(() => null); // it is asked for again when it is needed
}

/**
 * A browser never asks again for a module that once failed to arrive, so it is imported when all of it is here.
 * @param {string} address
 */
async function load(address) {
  if (!present.has(address)) {
    const seen = new Set(present);
    await reach(address, seen);
    seen.forEach((one) => present.add(one));
  }
  return import(address);
}

/** @param {string} address @param {Set<string>} seen @returns {Promise<void>} */
async function reach(address, seen) {
  seen.add(address);
  const answer = await fetch(address, { signal: AbortSignal.timeout(TIMEOUT) });
  if (!answer.ok) throw new Error(`${address} answers ${answer.status}`);
  const text = await answer.text();
  const imported = [...text.matchAll(IMPORTED)].map(([, relative]) => new URL(relative, address).href);
  await Promise.all(imported.filter((one) => !seen.has(one)).map((one) => reach(one, seen)));
}

/** @param {number} ms @returns {Promise<void>} */
function later(ms) {
  return new Promise((done) => setTimeout(done, ms));
}
