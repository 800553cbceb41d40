// Keeps a job's page up to date; without it the page reloads itself.

const INTERVAL = 700; // milliseconds

const main = document.querySelector("[data-job]");
const part = (name) => main.querySelector(`[data-job-${name}]`);

const show = (job) => {
  const state = part("state");
  const label = main.dataset[job.state] ?? job.state;
  if (state.textContent !== label) state.textContent = label;
  state.className = `state ${job.state}`;
  part("count").textContent = job.total ? `${Math.floor((100 * job.done) / job.total)} %` : "";
  part("message").textContent = job.message;
  if (job.state !== "queued") part("waiting")?.remove();
  if (job.total) {
    part("progress").max = job.total;
    part("progress").value = job.done;
  }
};

const poll = async () => {
  try {
    const answer = await fetch(main.dataset.job, { headers: { Accept: "application/json" } });
    // Logged out meanwhile, or the job is gone: the page itself knows what to say.
    if ([401, 403, 404].includes(answer.status)) return location.reload();
    if (answer.ok) {
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
