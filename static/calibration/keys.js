const FINE = 0.25; // pixels that an arrow moves
const FAR = 5; // with Shift

/** @type {{[key: string]: number[]}} */
const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/**
 * What the keys mean on a page of the desk.
 * @typedef {object} Keys
 * @property {{[name: string]: () => void}} actions by name; `undo` and `redo` among them
 * @property {{[key: string]: string}} names of actions by key, letters in lower case
 * @property {(dx: number, dy: number) => void} nudge by pixels
 * @property {(index: number) => boolean} choose the camera of a digit; false where there is none
 */

/** Keys go where nothing else wants them: not into fields and dialogs, Enter not onto buttons. @param {Keys} keys */
export function listenToKeys(keys) {
  document.addEventListener("keydown", (event) => {
    const target = event.target instanceof Element ? event.target : null;
    if (event.altKey || target?.closest("input, select, textarea, dialog")) return;
    if (event.key === "Enter" && target?.closest("a, button, summary")) return;
    if (pressed(keys, event)) event.preventDefault();
  });
}

/** Buttons say by `data-do` which action is theirs. @param {Element} page @param {Keys["actions"]} actions */
export function listenToButtons(page, actions) {
  for (const button of page.querySelectorAll("[data-do]"))
    if (button instanceof HTMLElement) button.addEventListener("click", () => actions[button.dataset.do ?? ""]?.());
}

/**
 * Whether the key meant something.
 * @param {Keys} keys @param {Pick<KeyboardEvent, "key"|"ctrlKey"|"metaKey"|"shiftKey">} event
 */
export function pressed({ actions, names, nudge, choose }, { key: pressed, ctrlKey, metaKey, shiftKey }) {
  const key = pressed.length === 1 ? pressed.toLowerCase() : pressed;
  if (ctrlKey || metaKey) {
    const wanted = key === "z" ? (shiftKey ? "redo" : "undo") : key === "y" ? "redo" : "";
    if (wanted) actions[wanted]();
    return Boolean(wanted);
  }
  if (ARROWS[key]) {
    const far = shiftKey ? FAR : FINE;
    const [dx, dy] = ARROWS[key];
    nudge(far * dx, far * dy);
    return true;
  }
  const digit = Number(key);
  if (digit >= 1 && choose(digit - 1)) return true;
  if (names[key]) actions[names[key]]();
  return Boolean(names[key]);
}
