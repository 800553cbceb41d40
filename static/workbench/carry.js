/** Which people a frame starts with. Pure: maps and a grid in, annotations out. */
import { CARRIED, annotation } from "./annotation.js";

/** The people of another frame at the same positions, to be looked at; `except` are already there. */
export function copyPeople(people, { except = new Map(), origin = "carried" } = {}) {
  return [...people.values()]
    .filter((one) => !except.has(one.person))
    .map((one) => annotation({ ...one, state: CARRIED, origin }));
}
