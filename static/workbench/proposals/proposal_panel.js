/**
 * @typedef {object} Parts
 * @property {import("./proposals.js").Proposals} proposals
 * @property {(id: string) => void} perform by the ids of the key table
 * @property {(threshold: number) => void} remember
 */
import { element, setText } from "../../base/dom.js";
import { gettext } from "../../base/messages.js";
import { toolButton } from "../keys/tool_button.js";
import { percent } from "./proposal_marks.js";

const STEP = 0.05;
const TIGHT = { minHeight: "0", padding: "0.3rem 1.2rem 0" };

/** Under the list of people: how many are proposed, from which score on they are taken for real, buttons. */
export class ProposalPanel {
  /** @param {Parts} parts */
  constructor({ proposals, perform, remember }) {
    this._proposals = proposals;
    this._remember = remember;
    this._count = element("p", { className: "details", role: "status" });
    this._value = element("output", {}, percent(proposals.threshold));
    this._slider = element("input", {
      type: "range",
      min: "0",
      max: "1",
      step: String(STEP),
      value: String(proposals.threshold),
      oninput: () => this._choose(),
      onchange: () => this._slider.blur(), // arrow keys move people, not the slider
    });
    Object.assign(this._slider.style, { flex: "1 1 6rem", minWidth: "4rem" });
    const label = element(
      "label",
      { className: "details" },
      gettext("Taken for real from"),
      " ",
      this._value,
      this._slider,
    );
    const tools = element(
      "div",
      { className: "panel-tools" },
      toolButton("acceptAll", gettext("Accept all"), perform),
      toolButton("doubtful", gettext("Doubtful ones"), perform),
    );
    this.element = element(
      "section",
      { className: "proposals", "aria-label": gettext("Proposals") },
      this._count,
      label,
      tools,
    );
    Object.assign(label.style, { ...TIGHT, display: "flex", gap: "0.5rem", alignItems: "center", borderTop: "0" });
    Object.assign(this._count.style, TIGHT);
    this.element.style.flex = "none"; // the list of people gives way
    proposals.on("change", () => this._tell());
    this._tell();
  }

  _choose() {
    this._proposals.threshold = Number(this._slider.value);
    setText(this._value, percent(this._proposals.threshold));
    this._remember(this._proposals.threshold);
  }

  _tell() {
    const { likely, doubtful } = this._proposals;
    const words = gettext("Proposed: {likely} to accept, {doubtful} doubtful", {
      likely: likely.length,
      doubtful: doubtful.length,
    });
    setText(this._count, likely.length + doubtful.length ? words : gettext("Proposed: nobody is left"));
  }
}
