/**
 * Fetches and unpacks grid files beside the page's own thread.
 * @typedef {{address: string, headers: Record<string, string>, width: number, height: number}} Question
 * @typedef {{loaded: number, total: number}} Progress bytes
 * @typedef {{boxes: Int16Array<ArrayBuffer>, feet: Int16Array<ArrayBuffer>|null, index: import("../geometry/feet.js").FootIndex|null,
 *            decoded: number}} Found `decoded`: ms
 * @typedef {Found|{error: string}} Answer
 */
import { indexFeet } from "../geometry/feet.js";
import { decodeGrid } from "../geometry/grid_file.js";

const EVERY = 250_000; // bytes between two reports

self.addEventListener("message", async ({ data }) => {
  /** @type {Question} */
  const { address, headers, width, height } = data;
  try {
    const packed = await fetchCounting(address, headers);
    const start = performance.now();
    const { boxes, feet } = decodeGrid(await unpack(packed));
    const index = feet && indexFeet({ boxes, feet, width, height });
    const decoded = performance.now() - start;
    const transfer = [boxes.buffer];
    if (feet && index) transfer.push(feet.buffer, index.starts.buffer, index.members.buffer);
    answer({ boxes, feet, index, decoded }, transfer);
  } catch (error) {
    answer({ error: error instanceof Error ? error.message : String(error) });
  }
});

/** @param {Answer|Progress} said @param {ArrayBuffer[]} [transfer] */
function answer(said, transfer = []) {
  self.postMessage(said, { transfer });
}

/** @param {string} address @param {Record<string, string>} headers @returns {Promise<Blob>} */
async function fetchCounting(address, headers) {
  const response = await fetch(address, { headers, credentials: "same-origin", priority: "low" });
  if (!response.ok || !response.body) throw new Error(`${response.status} ${response.statusText}`);
  const total = Number(response.headers.get("Content-Length"));
  /** @type {Uint8Array<ArrayBuffer>[]} */
  const chunks = [];
  let [loaded, told] = [0, 0];
  for (const reader = response.body.getReader(); ; ) {
    const { done, value } = await reader.read();
    if (done) return new Blob(chunks);
    chunks.push(value);
    loaded += value.length;
    if (loaded - told < EVERY) continue;
    told = loaded;
    answer({ loaded, total });
  }
}

/** @param {Blob} blob */
function unpack(blob) {
  return new Response(blob.stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}
