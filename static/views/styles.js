/**
 * How a person is drawn. Colour and line style say the same thing twice: carried over = yellow and dashed,
 * validated = white and thin, selected = cyan and double with corner handles; a selected person that is still
 * carried over stays dashed. Colours lie on photographs, so they are the same in the dark and the light theme.
 * @typedef {{colour: string, width: number, dash: number[], selected: boolean}} Style
 * @typedef {Style & {name: string}} Look
 * @typedef {"validated"|"carried"|"selected"|"selectedCarried"|"ghost"|"refused"} LookName
 */
export const CYAN = "#2fe3f7";
export const WHITE = "#ffffff";
export const YELLOW = "#ffd21f";
export const HALO = "rgba(6, 12, 18, 0.75)";
export const RIM = "rgba(6, 12, 18, 0.8)"; // thin, around every line: light lines stay visible on light pavement
export const INK = "#08131a";

/** @type {Record<LookName, Look>} */
export const LOOKS = {
  validated: { name: "validated", colour: WHITE, width: 1.5, dash: [], selected: false },
  carried: { name: "carried", colour: YELLOW, width: 1.75, dash: [6, 4], selected: false },
  selected: { name: "selected", colour: CYAN, width: 2, dash: [], selected: true },
  selectedCarried: { name: "selectedCarried", colour: CYAN, width: 2, dash: [7, 5], selected: true },
  ghost: { name: "ghost", colour: CYAN, width: 1.75, dash: [3, 3], selected: false },
  refused: { name: "refused", colour: "#ff8f86", width: 1.75, dash: [3, 3], selected: false },
};

/** @param {{state?: string}} annotation @param {boolean} selected */
export function lookOf(annotation, selected) {
  if (selected) return annotation.state === "carried" ? LOOKS.selectedCarried : LOOKS.selected;
  return annotation.state === "carried" ? LOOKS.carried : LOOKS.validated;
}
