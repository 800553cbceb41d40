import { pageJson, required, setText } from "../base/dom.js";
import { paths } from "./paths.js";
import { fetchAhead, pictures } from "./pictures.js";
import { Queue } from "./queue.js";

/** @typedef {import("./queue.js").Conflict} Conflict */

const page = required(document, "[data-conflicts]", HTMLElement);
const given = pageJson("queue");
const csrf = required(page, "[name=csrfmiddlewaretoken]", HTMLInputElement).value;
const part = (/** @type {string} */ name) => required(page, `[data-${name}]`, HTMLElement);
const [question, left, problem, buttons, sides, end] = [
  ...["question", "left", "problem", "buttons", "sides", "end"].map(part),
];

/** @param {string} address @param {RequestInit} [options] */
async function asked(address, options = {}) {
  const headers = { Accept: "application/json", "Content-Type": "application/json", "X-CSRFToken": csrf };
  const answer = await fetch(given.conflicts + address, { ...options, headers });
  const content = await answer.json().catch(() => ({}));
  if (!answer.ok) throw new Error(content.message || `The server answered ${answer.status}.`);
  return content;
}

const named = Number(location.hash.slice(1));
const queue = new Queue(named && !given.ids.includes(named) ? [named, ...given.ids] : given.ids, {
  detail: (id) => asked(`${id}/`),
  decide: (id, decision) => asked(`${id}/decide/`, { method: "POST", body: JSON.stringify({ decision }) }),
  undo: (id) => asked(`${id}/undo/`, { method: "POST" }),
});
if (named) queue.index = Math.max(queue.ids.indexOf(named), 0);

/** @param {unknown} error */
function tell(error) {
  problem.hidden = !error;
  setText(problem, error instanceof Error ? error.message : "");
}

/** @param {Conflict} conflict */
function words({ kind, left_at, came_at, metres, seconds }) {
  const apart = `${metres.toFixed(2)} m apart`;
  if (kind === "return")
    return `One person? Left after frame ${left_at}, back in frame ${came_at}: ${seconds.toFixed(0)} s later, ${apart}`;
  if (left_at === came_at) return `One person? Two batches share frame ${left_at} and have them ${apart}`;
  return `One person? Last seen in frame ${left_at}, first seen in frame ${came_at}, ${apart}`;
}

const SAID = new Map([
  ["same", "decided: the same person"],
  ["apart", "decided: two people"],
]);

/** @param {Conflict} conflict */
function draw(conflict) {
  setText(question, words(conflict));
  part("pictures").replaceChildren(...pictures(conflict, given.images));
  if (!conflict.pictures.length) part("pictures").textContent = "No view sees them.";
  part("paths").replaceChildren(paths(conflict));
  page.dataset.shown = String(conflict.id);
}

function count() {
  const said = SAID.get(queue.said.get(queue.current) ?? "");
  setText(left, [`${queue.index + 1} of ${queue.ids.length}`, `${queue.left} open`, said].filter(Boolean).join(" · "));
}

async function show() {
  const id = queue.current;
  const done = queue.ids.length === 0 || queue.left === 0;
  end.hidden = !done;
  sides.hidden = buttons.hidden = id === undefined;
  if (id === undefined) return setText(question, "The same person?");
  try {
    const conflict = await queue.detail(id);
    if (queue.current !== id) return; // somebody went on meanwhile
    draw(conflict);
    end.hidden = queue.left > 0;
    count();
    for (const next of queue.ahead()) queue.detail(next).then((each) => fetchAhead(each, given.images), tell);
  } catch (error) {
    tell(error);
  }
}

/** @param {Promise<unknown>|null} sent */
function after(sent) {
  tell(null);
  sent?.catch((error) => {
    void show();
    tell(error);
  });
}

/** @type {{[key: string]: () => void}} */
const actions = {
  j: () => after(queue.decide("same")),
  k: () => after(queue.decide("apart")),
  u: () => after(queue.undo()),
  ArrowLeft: () => queue.move(-1),
  ArrowRight: () => queue.move(1),
};

/** @param {string} key */
function press(key) {
  const action = actions[key];
  if (!action || queue.ids.length === 0) return false;
  action();
  void show();
  return true;
}

document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  if (press(event.key.length === 1 ? event.key.toLowerCase() : event.key)) event.preventDefault();
});
for (const button of page.querySelectorAll("[data-key]"))
  if (button instanceof HTMLElement) button.addEventListener("click", () => press(button.dataset.key ?? ""));

void show();
