import { openDialog } from "../../base/dialogs.js";
import { element, pageJson, required, setText } from "../../base/dom.js";
import { paintSoon } from "../../base/repaint.js";
import { Saver } from "../saver.js";
import { Server } from "../server.js";
import { videoTime } from "./clocks.js";
import { Events } from "./events.js";
import { Guessing } from "./guess.js";
import { HELP, meant } from "./keys.js";
import { TimeLine } from "./line.js";
import { Pictures } from "./pictures.js";
import { Player, RATE } from "./player.js";
import { Revised } from "./revised.js";
import { Store } from "./store.js";
import { Tiles } from "./tiles.js";
import { clockTime } from "./words.js";

const FAR = 5; // seconds
const page = required(document, "[data-sync]", HTMLElement);
const part = (/** @type {string} */ name) => required(page, `[data-${name}]`, HTMLElement);
const { draft, api, jobs } = pageJson("sync");
const csrf = required(page, "[name=csrfmiddlewaretoken]", HTMLInputElement).value;
const server = new Server(api, csrf);
const revised = new Revised(server, draft.revision);
const saver = new Saver(revised);
const store = new Store(draft, saver, revised);
const painter = { paint };
const pictures = new Pictures(api, draft.videos, () => paintSoon(painter));
const tiles = new Tiles(part("videos"), store, pictures);
const player = new Player(store, pictures, () => tiles.shown);
const line = new TimeLine(part("line"), store);
const guessing = new Guessing(part("guess"), store, server, new Server(jobs, csrf));
const events = new Events(part("events"), store, act);

function paint() {
  tiles.draw(player);
  line.draw();
  events.draw();
  const { clock, time } = store;
  setText(part("time"), clockTime(time));
  setText(part("selected-name"), `Move ${clock.camera}:`);
  setText(part("play-word"), player.playing ? "Stop" : "Play");
  setText(part("large-word"), tiles.large ? "All videos" : "Only two, large");
  setText(part("shown"), shown());
  for (const name of /** @type {const} */ (["undo", "redo"]))
    required(page, `[data-do=${name}]`, HTMLButtonElement).disabled = !store.draft[name];
}

function shown() {
  if (player.waiting) return "Waiting for the server's pictures; all videos wait together.";
  if (!player.playing) return overlapWords();
  const late = player.late > 0.5 ? `; waited ${player.late.toFixed(1)} s for the server so far` : "";
  return `Playing ${RATE} pictures a second of each video${late}.`;
}

function overlapWords() {
  const { from, until, first, last } = store.shared;
  const count = store.used.length;
  if (until <= from) return `No instant is in all ${count} videos: ${last} begins after ${first} is over.`;
  const told = `In all ${count} videos: ${clockTime(from)} to ${clockTime(until)}, ${(until - from).toFixed(1)} s.`;
  return from < -0.05 ? `${told} What lies before 0 is not imported.` : told;
}

/** @param {string} text */
function tell(text) {
  part("problem").hidden = !text;
  setText(part("problem"), text);
}

function tellSaved() {
  const stuck = "Not saved yet: the server does not answer; trying again";
  setText(part("saved"), saver.idle ? "Everything is saved" : saver.stuck ? stuck : "Saving…");
}

/** After a refusal: what the server has. */
async function reload() {
  try {
    const now = await server.ask("GET", "");
    const files = (/** @type {import("./store.js").Draft} */ { clocks }) => clocks.map(({ file }) => file).join();
    if (files(now) !== files(store.draft))
      location.reload(); // the page is of other videos
    else store.replace(now);
  } catch (error) {
    tell(error instanceof Error ? error.message : String(error));
  }
}

function mark() {
  // The picture that is seen, not the instant between two.
  const { clock } = store;
  if (player.playing) player.stop();
  const seen = tiles.seen.get(clock.file);
  const at = videoTime(clock, store.time);
  const near = seen !== undefined && Math.abs(seen - at) <= store.video(clock).interval;
  if (near) store.mark(seen);
}

function help() {
  const rows = HELP.map(({ keys, text }) =>
    element("tr", {}, element("td", {}, element("kbd", {}, keys)), element("td", {}, text)),
  );
  const body = element("table", { className: "sync-help" }, element("tbody", {}, ...rows));
  const dialog = openDialog({ title: "Keys", body, wide: true });
  dialog.append(element("form", { method: "dialog" }, element("button", { className: "small" }, "Close")));
  dialog.showModal();
}

function step(/** @type {number} */ count) {
  if (player.playing) player.stop();
  store.step(count);
}

/** @param {number} count */
function shift(count) {
  store.shift(count * store.video(store.clock).interval);
}

/** @type {{[name: string]: () => void}} */
const actions = {
  play: () => (player.playing ? player.stop() : player.start()),
  back: () => step(-1),
  forth: () => step(1),
  backTen: () => step(-10),
  forthTen: () => step(10),
  backFar: () => store.goTo(store.time - FAR),
  forthFar: () => store.goTo(store.time + FAR),
  home: () => store.goTo(store.shared.from),
  end: () => store.goTo(store.shared.until),
  above: () => store.selectNext(-1),
  below: () => store.selectNext(1),
  earlier: () => shift(-1),
  later: () => shift(1),
  earlierTen: () => shift(-10),
  laterTen: () => shift(10),
  minus: () => store.shift(-0.001),
  plus: () => store.shift(0.001),
  mark,
  unmark: () => store.unmark(),
  event: () => store.addEvent(),
  nextEvent: () => store.selectEvent((store.eventIndex + 1) % Math.max(store.draft.events.length, 1)),
  set: () => store.setByEvent(),
  drift: () => store.setDrifts(),
  refer: () => store.refer(),
  large: () => {
    tiles.large = !tiles.large;
    player.forget();
    paintSoon(painter);
  },
  guess: () => void guessing.start(),
  take: () => guessing.take(),
  undo: () => store.ask("undo"),
  redo: () => store.ask("redo"),
  help,
};

/** @param {string} name */
function act(name) {
  if (/^[1-9]$/.test(name)) store.select(Number(name) - 1);
  else actions[name]?.();
}

document.addEventListener("keydown", (event) => {
  const target = event.target instanceof Element ? event.target : null;
  if (target?.closest("input:not([type=checkbox]), select, textarea, dialog")) {
    if (event.key === "Enter" && target instanceof HTMLElement) target.blur();
    return;
  }
  if (event.key === " " && target?.closest("a, summary, input")) return;
  const name = meant(event);
  if (!name) return;
  event.preventDefault();
  act(name);
});
for (const button of page.querySelectorAll("[data-do]"))
  if (button instanceof HTMLElement && !part("events").contains(button))
    button.addEventListener("click", () => act(button.dataset.do ?? ""));

store.on("changed", () => {
  player.forget();
  guessing.draw();
  paintSoon(painter);
});
store.on("moved", () => paintSoon(painter));
saver.on("state", tellSaved);
saver.on("answer", () => tell(""));
saver.on("refused", (text) => {
  if (!text) return; // it was made from what had been refused before
  tell(text);
  void reload();
});
addEventListener("beforeunload", (event) => {
  if (!saver.idle) event.preventDefault();
});
new ResizeObserver(() => paintSoon(painter)).observe(part("videos"));

tell(draft.problem);
tellSaved();
guessing.draw();
paintSoon(painter);
