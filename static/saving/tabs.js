/**
 * Which tab this is. A tab keeps its name over a reload (session storage); a duplicated tab gets a new one.
 * Tabs of one layer answer each other, so that a crashed tab's edits are told from an open tab's.
 * @typedef {object} Tab
 * @property {string} name
 * @property {Set<string>} alive names of the others
 * @property {BroadcastChannel} channel
 * @property {number} next the number this tab gives away next, as it told the others
 * @property {number} heard the same of the others
 * @property {(next: number) => void} onNumbers
 */
import { uuid4 } from "../base/identifiers.js";

const KEY = "gtm-tab";
const PATIENCE = 120; // ms other tabs have to answer

/** @param {string} layer */
export async function joinTabs(layer) {
  const channel = new BroadcastChannel(`gtm-layer-${layer}`);
  const asking = uuid4();
  /** @type {Tab} */
  const tab = { name: storedName(), alive: new Set(), channel, next: 0, heard: 0, onNumbers: () => {} };
  channel.onmessage = ({ data }) => {
    if (data.kind === "who" && data.asking !== asking)
      channel.postMessage({ kind: "here", name: tab.name, next: tab.next });
    if (data.kind === "here") tab.alive.add(data.name);
    if (!data.next) return;
    tab.heard = Math.max(tab.heard, data.next);
    tab.onNumbers(tab.heard);
  };
  channel.postMessage({ kind: "who", asking });
  await new Promise((resolve) => setTimeout(resolve, PATIENCE));
  if (tab.alive.has(tab.name)) tab.name = uuid4();
  remember(tab.name);
  return tab;
}

/**
 * Tabs tell each other which person numbers are given away, long before the server knows.
 * @param {Tab} tab @param {import("../truth/store.js").Store} store
 */
export function shareNumbers(tab, store) {
  tab.onNumbers = (next) => store.reservePerson(next - 1);
  tab.onNumbers(tab.heard);
  store.on("change", () => {
    if (store.nextPerson <= Math.max(tab.next, tab.heard)) return;
    tab.next = store.nextPerson;
    tab.channel.postMessage({ kind: "numbers", next: tab.next });
  });
}

function storedName() {
  try {
    return sessionStorage.getItem(KEY) ?? uuid4();
  } catch {
    return uuid4(); // storage may be forbidden
  }
}

/** @param {string} name */
function remember(name) {
  try {
    sessionStorage.setItem(KEY, name);
  } catch {
    // the tab then has another name after a reload, and finds its edits as those of a closed tab
  }
}
