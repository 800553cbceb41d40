/** What the tutorial asks for, in order. The server judges each step against the truth it keeps to itself. */

import { gettext } from "../../base/messages.js";
import { keyFor } from "../keys/keys.js";

/** @typedef {import("../../truth/annotation.js").Annotation} Annotation */

/** @param {Annotation} one */
const isYellow = ({ state }) => state === "carried";

/**
 * @typedef {{parts?: string, people?: (one: Annotation) => boolean}} Light
 * @typedef {{id: string, frame: number, title: string, text: string, hint: string, light: Light}} Step `frame`: counted
 *   from 0; `light`: what the spotlight is on
 * @returns {Step[]}
 */
export function tutorialSteps() {
  return [
    {
      id: "place",
      frame: 0,
      title: gettext("Mark somebody"),
      text: gettext(
        "The person in the ring has no box. Click on the ground between their shoes – not on the body. A box appears in every view at once.",
      ),
      hint: gettext("For practice only three people have boxes here; the others do not matter yet."),
      light: {},
    },
    {
      id: "correct",
      frame: 0,
      title: gettext("Correct a yellow box"),
      text: gettext(
        "The yellow, dashed box stands beside its person. Click on it, or press {next}. Then click with the right button between the person's shoes. All boxes are equally tall: one may stand out over a head, only the feet count.",
        { next: keyFor("nextCarried") },
      ),
      hint: gettext("{zoom} shows it close up in every view, and back. Arrow keys move it by 2.5 cm.", {
        zoom: keyFor("zoom"),
      }),
      light: { people: isYellow },
    },
    {
      id: "remove",
      frame: 0,
      title: gettext("Remove a box with nobody in it"),
      text: gettext("One box has nobody in it: look at it in several views. Click on it and press {remove}.", {
        remove: keyFor("remove"),
      }),
      hint: gettext("Wrong one? {undo} brings it back.", { undo: keyFor("undo") }),
      light: {},
    },
    {
      id: "next",
      frame: 1,
      title: gettext("The next frame, one by one"),
      text: gettext(
        "Press {on}: everybody has a box here, but two walked on, and their yellow boxes stayed behind. Press {round}: each comes close up in all views. Click with the right button between the shoes, and the next one comes; where a box is right, press {validateNext}.",
        { on: keyFor("nextFrame"), round: keyFor("round"), validateNext: keyFor("validateNext") },
      ),
      hint: gettext("Inside somebody else's box, hold Shift while you click to mark somebody new."),
      light: { parts: '[data-action="nextFrame"]', people: isYellow },
    },
  ];
}

/** What is paid attention to in real work. */
export function whatMatters() {
  return [
    gettext("Everybody on the ground area has a box."),
    gettext("Feet are within 15 cm, looked at in two views."),
    gettext("One person keeps one number in all frames."),
    gettext("Nobody is left yellow, and no box is empty."),
    gettext("{help} shows every key. After the last frame, {on} hands in your work.", {
      help: keyFor("help"),
      on: keyFor("nextFrame"),
    }),
  ];
}
