// Keeps a job's page up to date; without it the page reloads itself.

const INTERVAL = 700; // milliseconds

/** @typedef {{state: string, total: number, done: number, message: string, finished_at: string|null}} Job */

/** @type {HTMLElement|null} */
const main = document.querySelector("[data-job]");
const [state, count, message] = ["state", "count", "message"].map((name) => main?.querySelector(`[data-job-${name}]`));
/** @type {HTMLProgressElement|null|undefined} */
const progress = main?.querySelector("[data-job-progress]");
const address = main?.dataset.job;
if (!main || !address || !state || !count || !message || !progress) throw new TypeError("there is no job to show");

/** @param {Job} job */
const show = (job) => {
  const label = main.dataset[job.state] ?? job.state;
  if (state.textContent !== label) state.textContent = label;
  state.className = `state ${job.state}`;
  count.textContent = job.total ? `${Math.floor((100 * job.done) / job.total)} %` : "";
  message.textContent = job.message;
  if (job.state !== "queued") main.querySelector("[data-job-waiting]")?.remove();
  if (job.total) {
    progress.max = job.total;
    progress.value = job.done;
  }
};

const poll = async () => {
  try {
    const answer = await fetch(address, { headers: { Accept: "application/json" } });
    // Logged out meanwhile, or the job is gone: the page itself knows what to say.
    if ([401, 403, 404].includes(answer.status)) return location.reload();
    if (answer.ok) {
      /** @type {Job} */
      const job = await answer.json();
      if (job.finished_at) return location.reload();
      show(job);
    }
  } catch {
    // The network comes back or it does not; ask again.
  }
  setTimeout(poll, INTERVAL);
};

setTimeout(poll, INTERVAL);

export {}; // a module: its names are its own
