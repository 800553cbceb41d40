/**
 * One person of the sheet: two views close up, and a line that says who it is and what became of it.
 * @typedef {import("../../truth/scene.js").Scene} Scene
 * @typedef {import("../../views/images.js").Images} Images
 * @typedef {import("../../views/pane.js").Placed} Placed
 * @typedef {import("./fused_foot.js").Click} Click
 * @typedef {import("./fused_foot.js").Known} Known
 * @typedef {import("./slots.js").Slot} Slot
 * @typedef {import("./slots.js").Shown} Shown
 * @typedef {import("./tile.js").Anchor} Anchor
 * @typedef {import("./tile.js").Area} Area
 * @typedef {{view: number, pixel: {x: number, y: number}, scale: number}} Hit a place of a picture, and CSS pixels per
 *   pixel of it
 */
import { element, setText } from "../../base/dom.js";
import { gettext } from "../../base/messages.js";
import { unit } from "../../base/scale.js";
import { contextOf } from "../../views/marks.js";
import { LOOKS } from "../../views/styles.js";
import { anchorOf, isInside, paintTile, transformIn } from "./tile.js";
import { tileViews } from "./tile_views.js";

const GAP = 2;
/** @type {Record<import("./slots.js").SlotState, import("../../views/styles.js").Style>} */
const STYLES = {
  open: { colour: "#a6ff9a", width: 1.75, dash: [6, 4], selected: false },
  doubtful: { colour: LOOKS.carried.colour, width: 1.75, dash: [2, 4], selected: false },
  accepted: LOOKS.validated,
  refused: LOOKS.refused,
};

export class SheetCell {
  /** @param {Scene} scene @param {Images} images @param {Slot} slot */
  constructor(scene, images, slot) {
    this._scene = scene;
    this._images = images;
    this.slot = slot;
    /** @type {Shown|null} */
    this.shown = null;
    /** @type {Anchor[]} the views, chosen once: pictures stay put while the marks move */
    this.anchors = [];
    /** @type {Click[]} on the feet, at most one in each view */
    this.clicks = [];
    /** @type {Known|null} where they were thought to be before the first click */
    this.known = null;
    /** @type {number|null} where the clicks have put them */
    this.put = null;
    this._size = { width: 0, height: 0 };
    this._ratio = 1;
    this._painted = "";
    this.canvas = element("canvas", {});
    this._who = element("strong", { className: "sheet-who" });
    this._state = element("span", { className: "sheet-state" });
    this.element = element(
      "li",
      { role: "option", "aria-selected": "false" },
      element("p", { className: "sheet-line" }, this._who, this._state),
      this.canvas,
    );
    this.element.id = `sheet-${slot.proposal ? `proposal-${slot.proposal.id}` : `person-${slot.person}`}`;
  }

  /** @param {Shown} shown @param {Placed[]} others everybody else of the frame */
  update(shown, others) {
    if (!this.shown) {
      const evidence = new Map(shown.slot.proposal?.evidence.map((one) => [one.camera, one]));
      const views = tileViews(this._scene, shown.placed, others, evidence);
      this.anchors = views.flatMap((view) => anchorOf(this._scene, shown.placed, view) ?? []);
    }
    if (shown.placed.position !== this.put) this.forget();
    this.shown = shown;
    setText(this._who, shown.person === null ? gettext("new") : String(shown.person));
    setText(this._state, stateWords(shown));
    this.element.dataset.state = shown.state;
    this.element.setAttribute("aria-label", `${this._who.textContent}: ${this._state.textContent}`);
  }

  /** Clicks count until somebody is moved by other means. */
  forget() {
    Object.assign(this, { clicks: [], known: null, put: null });
  }

  /** @param {{width: number, height: number}} size of the canvas, units */
  resize({ width, height }) {
    const ratio = (window.devicePixelRatio || 1) * unit();
    if (width === this._size.width && height === this._size.height && ratio === this._ratio) return;
    this._ratio = ratio;
    this._size = { width, height };
    Object.assign(this.canvas, { width: Math.round(width * ratio), height: Math.round(height * ratio) });
    Object.assign(this.canvas.style, { width: `${width * unit()}px`, height: `${height * unit()}px` });
    this._painted = "";
  }

  /** @param {number} frame @returns {boolean} whether its pictures are as sharp as they become */
  paint(frame) {
    const { shown } = this;
    if (!shown) return false;
    const tiles = this.tiles().map((tile) => ({ ...tile, picture: this._images.show(frame, tile.view, true) }));
    const pictures = tiles.map(({ picture }) => `${picture.size}${picture.bitmap ? 1 : 0}`);
    const look = `${frame} ${shown.state} ${shown.placed.position} ${shown.placed.height} ${pictures}`;
    const sharp = tiles.every(({ picture }) => picture.size === "full" && picture.status === "ready");
    if (look === this._painted) return sharp;
    this._painted = look;
    const ctx = contextOf(this.canvas);
    ctx.setTransform(this._ratio, 0, 0, this._ratio, 0, 0);
    ctx.clearRect(0, 0, this._size.width, this._size.height);
    for (const [index, { view, area, transform, picture }] of tiles.entries()) {
      const painting = { scene: this._scene, transform, area, view, picture: picture.bitmap, placed: shown.placed };
      paintTile(ctx, { ...painting, style: STYLES[shown.state], whole: index === 0 });
    }
    return sharp;
  }

  /** @returns {{view: number, area: Area, transform: import("../../views/transform.js").Transform}[]} */
  tiles() {
    const { width, height } = this._size;
    const across = (width - GAP * (this.anchors.length - 1)) / Math.max(1, this.anchors.length);
    this.anchors = this.anchors.map((anchor, index) => this._moved(anchor, this._area(index, across, height)));
    return this.anchors.map((anchor, index) => {
      const area = this._area(index, across, height);
      return { view: anchor.view, area, transform: transformIn(anchor, area) };
    });
  }

  /** @param {number} index @param {number} width @param {number} height @returns {Area} */
  _area(index, width, height) {
    return { x: index * (width + GAP), y: 0, width, height };
  }

  /** Whoever goes far is followed. @param {Anchor} anchor @param {Area} area */
  _moved(anchor, area) {
    const placed = this.shown?.placed;
    const foot = placed && this._scene.toImage(anchor.view, this._scene.metres(placed.position));
    if (!foot || isInside(transformIn(anchor, area), area, foot)) return anchor;
    return { ...anchor, foot };
  }

  /** What of which picture is under the pointer. @param {MouseEvent} event @returns {Hit|null} */
  hit({ clientX, clientY }) {
    const bounds = this.canvas.getBoundingClientRect();
    const [x, y] = [(clientX - bounds.left) / unit(), (clientY - bounds.top) / unit()];
    const tile = this.tiles().find(({ area }) => x >= area.x && x < area.x + area.width && y >= 0 && y < area.height);
    if (!tile) return null;
    return { view: tile.view, pixel: tile.transform.toSource(x, y), scale: tile.transform.scale * unit() };
  }
}

/** @param {Shown} shown */
function stateWords({ state, slot, placed }) {
  if (state === "accepted") return gettext("✓ accepted");
  if (state === "refused") return gettext("✗ nobody");
  if (slot.proposal !== placed) return gettext("carried over");
  const percent = Math.round(100 * slot.proposal.score);
  return state === "doubtful" ? gettext("? {percent} %", { percent }) : gettext("{percent} %", { percent });
}
