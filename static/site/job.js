// Keeps a job's page up to date; without it the page reloads itself.

const INTERVAL = 700; // milliseconds

const main = document.querySelector("[data-job]");
const part = (name) => main.querySelector(`[data-job-${name}]`);

const show = (job) => {
  const state = part("state");
  if (state.textContent !== job.label) state.textContent = job.label;
  state.className = `state ${job.state}`;
  part("count").textContent = job.total ? `${job.percent} %` : "";
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
    if (answer.redirected || answer.status === 404) return location.reload();
    if (answer.ok) {
      const job = await answer.json();
      if (job.finished) return location.reload();
      show(job);
    }
  } catch {
    // The network comes back or it does not; ask again.
  }
  setTimeout(poll, INTERVAL);
};

setTimeout(poll, INTERVAL);
