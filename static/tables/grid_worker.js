/** Fetches and unpacks grid files beside the page's own thread. See tables.js for what is asked and answered. */
import { indexFeet } from "../geometry/feet.js";
import { decodeGrid } from "../geometry/grid_file.js";

const EVERY = 250_000; // bytes between two reports

self.addEventListener("message", async ({ data: { address, headers, width, height } }) => {
  try {
    const packed = await fetchCounting(address, headers);
    const start = performance.now();
    const { boxes, feet } = decodeGrid(await unpack(packed));
    const index = feet && indexFeet({ boxes, feet, width, height });
    const decoded = performance.now() - start;
    const moved = index ? [feet.buffer, index.starts.buffer, index.members.buffer] : [];
    self.postMessage({ boxes, feet, index, decoded }, [boxes.buffer, ...moved]);
  } catch (error) {
    self.postMessage({ error: error.message });
  }
});

/** @returns {Promise<Blob>} */
async function fetchCounting(address, headers) {
  const response = await fetch(address, { headers, credentials: "same-origin", priority: "low" });
  if (!response.ok) throw new Error(`${response.status} ${response.statusText}`);
  const total = Number(response.headers.get("Content-Length"));
  const chunks = [];
  let [loaded, told] = [0, 0];
  for (const reader = response.body.getReader(); ; ) {
    const { done, value } = await reader.read();
    if (done) return new Blob(chunks);
    chunks.push(value);
    loaded += value.length;
    if (loaded - told < EVERY) continue;
    told = loaded;
    self.postMessage({ loaded, total });
  }
}

function unpack(blob) {
  return new Response(blob.stream().pipeThrough(new DecompressionStream("gzip"))).arrayBuffer();
}
