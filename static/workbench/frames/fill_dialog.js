import { ask } from "../../base/dialogs.js";
import { element } from "../../base/dom.js";
import { gettext, ngettext } from "../../base/messages.js";
import { extendEdits, fillEdits, keyframes } from "../../truth/keyframes.js";
import { pathMap } from "../../views/path_map.js";
import { LOOKS } from "../../views/styles.js";
import { keyFor } from "../keys/keys.js";

/**
 * @typedef {import("../../truth/store.js").PersonEdit} PersonEdit
 * @typedef {import("../../truth/scene.js").Scene} Scene
 * @typedef {import("../../truth/store.js").Store} Store
 * @typedef {ReturnType<typeof import("../../views/display.js").mapColours>} MapColours
 * @typedef {{id: "between"|"further"|"all", edits: PersonEdit[], label: string, skip?: boolean}} Offer
 */

/**
 * Shows what can be filled in, before anything is.
 * @param {number|null} person the selected one
 * @returns {Promise<PersonEdit[]|null>} the edits the annotator chose; empty: there is nothing to fill
 * @param {Store} store @param {Scene} scene @param {MapColours} mapColours
 */
export async function chooseFill(store, scene, mapColours, person) {
  const offers = offersFor(store, scene, person);
  if (!offers.length) return [];
  const map = element("div", { className: "path-map" });
  /** @param {Offer} offer */
  const preview = ({ edits }) => map.replaceChildren(previewMap(store, scene, mapColours, edits));
  preview(offers[0]);
  const answered = ask({
    title: person === null ? gettext("Fill in between keyframes") : gettext("Fill in person {person}", { person }),
    body: [
      ...offers.map((offer) => describe(store, offer)),
      map,
      gettext("Who is filled in stays yellow until looked at. {key} takes all of it back.", { key: keyFor("undo") }),
    ],
    buttons: [
      ...offers.map(({ id, label }, index) => ({ id, label, main: index === 0 })),
      { id: "cancel", label: gettext("Cancel") },
    ],
  });
  // The map shows what the button does that one is about to press.
  /** @param {Event} event */
  const about = ({ target }) => {
    const button = target instanceof Element ? target.closest("[data-answer]") : null;
    const offer = offers.find(({ id }) => id === button?.getAttribute("data-answer"));
    if (offer) preview(offer);
  };
  for (const event of ["focusin", "pointerover"]) map.closest("dialog")?.addEventListener(event, about);
  const answer = await answered;
  return offers.find(({ id }) => id === answer)?.edits ?? null;
}

/**
 * @returns {Offer[]} what there is to fill, the narrowest first
 * @param {Store} store @param {Scene} scene @param {number|null} person
 */
function offersFor(store, scene, person) {
  const everybody = new Set(store.numbers.flatMap((number) => [...store.people(number).keys()]));
  const own = person === null ? [] : fillEdits(store, scene, person);
  const all = [...everybody].flatMap((one) => (one === person ? own : fillEdits(store, scene, one)));
  const further = person === null ? [] : extendEdits(store, scene, person);
  /** @type {Offer[]} */
  const offers = [
    { id: "between", edits: own, label: ngettext("Fill {n} frame", "Fill {n} frames", own.length) },
    {
      id: "further",
      edits: [...own, ...further],
      label: gettext("Fill all frames of the batch"),
      skip: !further.length,
    },
    { id: "all", edits: all, label: gettext("Fill in everybody between keyframes"), skip: all.length === own.length },
  ];
  return offers.filter(({ edits, skip }) => edits.length && !skip);
}

/** @param {Store} store @param {Offer} offer */
function describe(store, { id, edits }) {
  const numbers = [...new Set(edits.map(({ frame }) => frame))].sort((one, other) => one - other);
  const places = numbers.map((number) => store.numbers.indexOf(number) + 1).join(", ");
  const sentence = {
    between: () =>
      ngettext(
        "On the straight line between the keyframes: frame {places}.",
        "On the straight line between the keyframes: frames {places}.",
        numbers.length,
        { places },
      ),
    further: () =>
      ngettext(
        "Further on, the way the person walks, as far as the batch goes: frame {places}.",
        "Further on, the way the person walks, as far as the batch goes: frames {places}.",
        numbers.length,
        { places },
      ),
    all: () =>
      ngettext(
        "Everybody between keyframes: {n} box in the frames {places}.",
        "Everybody between keyframes: {n} boxes in the frames {places}.",
        edits.length,
        { places },
      ),
  }[id]();
  const finished = numbers.filter((number) => store.frame(number).done).length;
  if (!finished) return element("p", { "data-offer": id }, sentence);
  const again = ngettext(
    "{n} of them is done now and will have to be looked at again.",
    "{n} of them are done now and will have to be looked at again.",
    finished,
  );
  return element("p", { "data-offer": id }, `${sentence} ${again}`);
}

/** @param {Store} store @param {Scene} scene @param {MapColours} mapColours @param {PersonEdit[]} edits */
function previewMap(store, scene, mapColours, edits) {
  const people = [...new Set(edits.map(({ person }) => person))];
  const paths = people.flatMap((person) => {
    /** @type {Map<number, number>} position by frame */
    const filled = new Map();
    for (const { frame, person: whom, after } of edits) if (whom === person && after) filled.set(frame, after.position);
    /** @type {[frame: number, position: number][]} */
    const kept = keyframes(store, person).map((number) => [number, store.marked(person, number).position]);
    const whole = [...filled, ...kept].sort(([one], [other]) => one - other).map(([, position]) => position);
    return [
      { positions: whole, look: LOOKS.carried },
      ...kept.map(([, position]) => ({ positions: [position], look: LOOKS.validated })),
    ];
  });
  return pathMap(scene, mapColours, paths, gettext("The paths with the filled in positions"));
}
