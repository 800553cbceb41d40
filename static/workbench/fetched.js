import { gettext } from "./messages.js";

const IMPORTED = /\bfrom\s*"(\.[^"]+)"/g;
// Whatever the page itself is made of is here before this line is run.
const present = new Set(performance.getEntriesByType("resource").map(({ name }) => name));

/**
 * A part that few need, fetched when it is needed. Where it does not arrive, the annotator is told and nothing
 * else happens; the next try fetches it again.
 * @param {{say: (text: string) => void}} notices
 * @param {string} address of its module, from import.meta.resolve
 * @param {(module: object) => object} make what the part is; called once
 * @returns {() => Promise<object|null>} the part, always the same; null: it did not arrive
 */
export function fetched(notices, address, make = (module) => module) {
  let part = null;
  return async () => {
    if (part) return part;
    const module = await load(address).catch((error) => console.warn("a part did not arrive", error));
    if (!module) notices.say(gettext("This part of the page did not arrive: the server does not answer. Nothing is lost – please try again"));
    return module ? (part ??= make(module)) : null;
  };
}

/** A browser never asks again for a module that once failed to arrive, so it is imported when all of it is here. */
async function load(address) {
  await reach(address, new Set(present));
  return import(address);
}

async function reach(address, seen) {
  seen.add(address);
  const answer = await fetch(address);
  if (!answer.ok) throw new Error(`${address} answers ${answer.status}`);
  const text = await answer.text();
  const imported = [...text.matchAll(IMPORTED)].map(([, relative]) => new URL(relative, address).href);
  await Promise.all(imported.filter((one) => !seen.has(one)).map((one) => reach(one, seen)));
}
