/** 100 × 80 positions of 10 cm; frames 0, 5, 10 … half a second apart; positions are written as [column, row]. */
import { Grid } from "../../static/geometry/grid.js";
import { annotation } from "../../static/truth/annotation.js";
import { Store } from "../../static/truth/store.js";

export const grid = new Grid({ columns: 100, rows: 80, step: 0.1, origin: [-5, 2] });
export const scene = {
  grid,
  neighbours: { before: [], after: [] },
  metres: (position) => grid.metres(position),
  seconds: (number) => number / 10,
};
export const YELLOW = { state: "carried" };

export const at = ([column, row]) => row * 100 + column;
export const cell = ({ position }) => [position % 100, Math.floor(position / 100)];
export const one = (person, place, values = {}) => annotation({ person, position: at(place), ...values });
export const people = (...all) => new Map(all.map((each) => [each.person, each]));

/** A store with a list of people for each frame; 50 is the next free number. */
export function frames(...all) {
  const store = new Store(
    all.map((_, index) => 5 * index),
    50,
  );
  all.forEach((list, index) => store.install(5 * index, { people: people(...list) }, "server"));
  return store;
}
