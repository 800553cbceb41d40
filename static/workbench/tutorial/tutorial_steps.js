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
      title: gettext("Mark somebody who has no box"),
      text: gettext(
        "One person in this frame has no box. Find them, and click on the ground between their feet, in the view where you see them best. The box appears in every view at once.",
      ),
      hint: gettext(
        "Inside somebody else's box, hold Shift while you click. A little off? The arrow keys move by 2.5 cm.",
      ),
      light: { parts: '[data-view^="camera"]' },
    },
    {
      id: "correct",
      frame: 0,
      title: gettext("Correct a yellow box"),
      text: gettext(
        "The yellow, dashed box in the ring was carried over and stands beside its person. Select it: click on it, or press {next}. Then click between the person's feet with the right button, or move it with the arrow keys, until it fits in all views.",
        { next: keyFor("nextCarried") },
      ),
      hint: gettext(
        "{zoom} zooms every view to it, and back. Moving says that you looked: it is not yellow any more.",
        { zoom: keyFor("zoom") },
      ),
      light: { people: isYellow },
    },
    {
      id: "remove",
      frame: 0,
      title: gettext("Remove a box with nobody in it"),
      text: gettext(
        "One box has nobody in it. Look at the boxes in several views. Found? Click on it and press {remove}.",
        { remove: keyFor("remove") },
      ),
      hint: gettext("Wrong one? {undo} brings it back.", { undo: keyFor("undo") }),
      light: { parts: '[data-view^="camera"]' },
    },
    {
      id: "next",
      frame: 1,
      title: gettext("Go to the next frame"),
      text: gettext(
        "Press {on}. Two people there are yellow: they still stand where they were a frame ago. Right-click between their feet, or use the arrow keys, until nobody is yellow.",
        { on: keyFor("nextFrame") },
      ),
      hint: gettext("{next} goes to the next yellow person. One who stands right already only needs {validate}.", {
        next: keyFor("nextCarried"),
        validate: keyFor("validate"),
      }),
      light: { parts: '[data-action="nextFrame"]', people: isYellow },
    },
  ];
}

/** What is paid attention to in real work. */
export function whatMatters() {
  return [
    gettext("Everybody on the ground area has a box, also those only one view shows well."),
    gettext("Feet are within 15 cm: look in two views before you believe one."),
    gettext("The same person keeps the same number in all frames."),
    gettext("Nobody is left yellow, and no box is empty."),
    gettext("Take the time it takes. {help} shows every key.", { help: keyFor("help") }),
  ];
}
