import { element } from "../../base/dom.js";

/**
 * @typedef {import("./store.js").Store} Store
 * @typedef {import("../saver.js").Asks} Asks
 * @typedef {{id: number, state: string, done: number, total: number, message: string}} Job
 */

const AGAIN = 700; // ms

/** The first guess: how far it is, what it was made from, and taking it over. */
export class Guessing {
  /** @param {HTMLElement} root @param {Store} store @param {Asks} draft @param {Asks} jobs */
  constructor(root, store, draft, jobs) {
    this._root = root;
    this._store = store;
    this._draft = draft;
    this._jobs = jobs;
    /** @type {Job|null} */
    this._job = null;
    this._problem = "";
    if (store.draft.job) this._follow({ ...store.draft.job, state: "running" });
  }

  async start() {
    if (this._job) return;
    this._problem = "";
    await this._try(async () => this._follow(await this._draft.ask("POST", "guess/")));
  }

  take() {
    if (this._store.draft.guess.places && !this._job) this._store.ask("guess/take");
  }

  /** @param {Job} job */
  _follow(job) {
    this._job = job;
    this.draw();
    setTimeout(() => void this._ask(), AGAIN);
  }

  async _ask() {
    const { id } = /** @type {Job} */ (this._job);
    try {
      const job = await this._jobs.ask("GET", `${id}/`);
      if (["queued", "running"].includes(job.state)) return this._follow(job);
      this._job = null;
      this._problem = job.state === "failed" ? job.message : job.state === "cancelled" ? "The guess was stopped." : "";
      const { guess } = await this._draft.ask("GET", "");
      this._store.draft = { ...this._store.draft, guess };
      this._store.emit("changed", null);
    } catch {
      setTimeout(() => void this._ask(), 3 * AGAIN); // the network comes back, or the page is left
    }
    this.draw();
  }

  /** @param {() => Promise<void>} work */
  async _try(work) {
    try {
      await work();
    } catch (error) {
      this._problem = error instanceof Error ? error.message : String(error);
    }
    this.draw();
  }

  draw() {
    const { guess } = this._store.draft;
    const parts = this._job ? this._running(this._job) : guess.places ? this._made() : this._none();
    this._root.replaceChildren(...parts);
    this._root.dataset.state = this._job ? "running" : guess.places ? "made" : "none";
  }

  /** @param {Job} job */
  _running({ id, done, total, message, state }) {
    const bar = element("progress", { max: Math.max(total, 1), value: done });
    const stop = () => void this._try(async () => void (await this._jobs.ask("POST", `${id}/cancel/`)));
    const words =
      state === "queued" ? "The first guess waits for a free worker." : `First guess: ${message || "begins"}`;
    return [bar, element("span", {}, words), button("Stop", "", stop)];
  }

  _none() {
    const words = this._problem || "No offsets were guessed yet: by sound if there is any, else by motion.";
    const className = this._problem ? "bad" : "muted";
    return [button("Guess", "G", () => void this.start()), element("span", { className }, words)];
  }

  _made() {
    const { told } = this._store.draft.guess;
    const again = button("Guess again", "G", () => void this.start());
    const words = element(
      "span",
      { className: this._problem ? "bad" : "" },
      this._problem || `First guess. ${told ?? ""}`,
    );
    const taken = this.isTaken ? [element("b", { className: "good" }, "In place")] : [];
    const untouched = this._store.clocks.every(({ offset }) => offset === 0);
    const take = button(untouched ? "Take it over" : "Take it over again", "T", () => this.take());
    take.classList.toggle("primary", untouched && !this.isTaken);
    return [...taken, take, again, words];
  }

  /** Whether the clocks are those of the guess, but for a shift of all. */
  get isTaken() {
    const { guess, clocks } = this._store.draft;
    const shifts = (guess.places ?? []).flatMap(({ file, offset }) => {
      const clock = clocks.find((each) => each.file === file);
      return clock && offset !== null ? [clock.offset - offset] : [];
    });
    return shifts.length > 0 && Math.max(...shifts) - Math.min(...shifts) < 5e-4;
  }
}

/** @param {string} word @param {string} key @param {() => void} onclick */
function button(word, key, onclick) {
  return element(
    "button",
    { type: "button", className: "small", onclick },
    key ? element("kbd", {}, key) : null,
    ` ${word}`,
  );
}
