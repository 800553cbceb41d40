/**
 * Which tab this is. A tab keeps its name over a reload (session storage); a duplicated tab gets a new one.
 * Tabs of one layer answer each other, so that a crashed tab's edits are told from an open tab's.
 */
import { uuid4 } from "./identifiers.js";

const KEY = "gtm-tab";
const PATIENCE = 120; // ms other tabs have to answer

export async function joinTabs(layer) {
  const channel = new BroadcastChannel(`gtm-layer-${layer}`);
  const asking = uuid4();
  const tab = { name: storedName(), alive: new Set(), channel };
  channel.onmessage = ({ data }) => {
    if (data.kind === "who" && data.asking !== asking) channel.postMessage({ kind: "here", name: tab.name });
    if (data.kind === "here") tab.alive.add(data.name);
  };
  channel.postMessage({ kind: "who", asking });
  await new Promise((resolve) => setTimeout(resolve, PATIENCE));
  if (tab.alive.has(tab.name)) tab.name = uuid4();
  remember(tab.name);
  return tab;
}

function storedName() {
  try {
    return sessionStorage.getItem(KEY) ?? uuid4();
  } catch {
    return uuid4(); // storage may be forbidden
  }
}

function remember(name) {
  try {
    sessionStorage.setItem(KEY, name);
  } catch {
    // the tab then has another name after a reload, and finds its edits as those of a closed tab
  }
}
