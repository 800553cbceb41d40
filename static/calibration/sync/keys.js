import { typed } from "../../base/key_press.js";

/** @typedef {{keys: string, text: string}} Line of the help */

/** @type {Line[]} */
export const HELP = [
  { keys: "1 … 9, ↑ ↓", text: "select a video" },
  { keys: "← →", text: "one picture of the selected video back, on; with Shift ten" },
  { keys: "Page up, Page down", text: "five seconds back, on" },
  { keys: "Home, End", text: "begin and end of what all videos see" },
  { keys: "Space", text: "play all in step; stop" },
  { keys: ", .", text: "move the selected video alone by one of its pictures; with Shift ten" },
  { keys: "− +", text: "move the selected video alone by 1 ms" },
  { keys: "M", text: "the event happens here in the selected video" },
  { keys: "N", text: "a new event" },
  { keys: "E", text: "the next event" },
  { keys: "Del", text: "take the mark of the selected video away" },
  { keys: "O", text: "set offsets so that this event is at one time in all videos where it is marked" },
  { keys: "D", text: "set drift and offset by all events" },
  { keys: "R", text: "the selected video is the reference: its offset is 0, the others are told from it" },
  { keys: "F", text: "only the reference and the selected video, large" },
  { keys: "G, T", text: "guess; take the guess over" },
  { keys: "Ctrl Z, Ctrl Y", text: "undo, redo" },
];

/** @type {{[key: string]: string}} */
const PLAIN = {
  " ": "play",
  ArrowLeft: "back",
  ArrowRight: "forth",
  ArrowUp: "above",
  ArrowDown: "below",
  PageUp: "backFar",
  PageDown: "forthFar",
  Home: "home",
  End: "end",
  ",": "earlier",
  ".": "later",
  "-": "minus",
  "+": "plus",
  "=": "plus",
  m: "mark",
  n: "event",
  e: "nextEvent",
  Delete: "unmark",
  Backspace: "unmark",
  o: "set",
  d: "drift",
  r: "refer",
  f: "large",
  g: "guess",
  t: "take",
  "?": "help",
};
/** @type {{[key: string]: string}} what Shift makes of these on American and other keyboards */
const SHIFTED = {
  ArrowLeft: "backTen",
  ArrowRight: "forthTen",
  "<": "earlierTen",
  ";": "earlierTen",
  ">": "laterTen",
  ":": "laterTen",
};

/** The name of what is to be done; a digit is a video's number; null: the key means nothing here. @param {KeyboardEvent} event */
export function meant(event) {
  const key = typed(event);
  if (event.altKey) return null;
  if (event.ctrlKey || event.metaKey)
    return key === "z" ? (event.shiftKey ? "redo" : "undo") : key === "y" ? "redo" : null;
  if (/^[1-9]$/.test(key)) return key;
  return (event.shiftKey && SHIFTED[key]) || PLAIN[key] || null;
}
