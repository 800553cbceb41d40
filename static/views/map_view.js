import { footprint } from "../geometry/ground.js";
import { drawFoot, drawLabel, drawPath, labelWidth } from "./marks.js";

const BORDER = 0.8; // metres around the grid
const DOT = 4.5; // CSS pixels

const UPRIGHT = {
  left: { columns: -1, rows: 0 },
  right: { columns: 1, rows: 0 },
  up: { columns: 0, rows: 1 },
  down: { columns: 0, rows: -1 },
};
const TURNED = {
  left: { columns: 0, rows: -1 },
  right: { columns: 0, rows: 1 },
  up: { columns: -1, rows: 0 },
  down: { columns: 1, rows: 0 },
};

/**
 * The ground from above, in metres. A long grid lies on its side, turned and never mirrored, so that it fills
 * a wide pane: then Y runs to the right and X downwards.
 * @typedef {import("../truth/scene.js").Scene} Scene
 * @typedef {import("./display.js").Options} Options
 * @typedef {import("./pane.js").Axes} Axes
 * @typedef {import("./pane.js").Person} Person
 * @typedef {import("./pane.js").PersonItem} PersonItem
 * @typedef {import("./pane.js").Placed} Placed
 * @typedef {import("./regions.js").Rectangle} Rectangle
 * @typedef {import("./regions.js").XY} XY
 * @typedef {import("./styles.js").Look} Look
 * @typedef {import("./transform.js").Transform} Transform
 * @typedef {import("./display.js").MapColours} MapColours
 * @typedef {import("./pane.js").PictureState} PictureState
 * @typedef {import("./pane.js").View} View
 * @typedef {{mapColours: MapColours, footprints?: boolean}} Ground how the map is painted; `footprints`: of the cameras
 * @implements {View}
 */
export class MapView {
  /** @param {Scene} scene @param {string} title */
  constructor(scene, title) {
    const { grid } = scene;
    this.id = "map";
    this.byTable = false;
    /** @type {number|null} */
    this.index = null;
    this.title = title;
    this.largest = 400; // CSS pixels per metre
    this._scene = scene;
    this._width = grid.columns * grid.step;
    this._height = grid.rows * grid.step;
    this._turned = this._height > this._width;
    const [across, down] = this._turned ? [this._height, this._width] : [this._width, this._height];
    this.size = { width: across + 2 * BORDER, height: down + 2 * BORDER };
    /** @type {XY[][]|null} */
    this._footprints = null;
  }

  /** @param {XY} place @returns {XY} */
  ground({ x, y }) {
    const { origin } = this._scene.grid;
    const [across, down] = [x - BORDER, y - BORDER];
    if (this._turned) return { x: origin[0] + down, y: origin[1] + across };
    return { x: origin[0] + across, y: origin[1] + this._height - down };
  }

  /** @param {XY} ground @returns {XY} */
  point(ground) {
    const { origin } = this._scene.grid;
    const [x, y] = [ground.x - origin[0], ground.y - origin[1]];
    return this._turned ? { x: y + BORDER, y: x + BORDER } : { x: x + BORDER, y: this._height - y + BORDER };
  }

  /** @param {Placed} annotation @returns {XY} */
  foot(annotation) {
    return this.point(this._scene.metres(annotation.position));
  }

  /**
   * The cylinder's footprint, in metres of the map.
   * @param {Placed} annotation @returns {Rectangle}
   */
  box(annotation) {
    const { x, y } = this.foot(annotation);
    const { radius } = this._scene.cylinderOf(annotation);
    return { xmin: x - radius, ymin: y - radius, xmax: x + radius, ymax: y + radius };
  }

  /**
   * The map's own directions, everywhere the same.
   * @returns {Axes}
   */
  axes() {
    return this._turned ? TURNED : UPRIGHT;
  }

  /** @returns {PictureState} */
  picture() {
    return { status: "ready", error: "" };
  }

  /** Nothing of it is fetched. */
  retry() {}

  /** @param {CanvasRenderingContext2D} ctx @param {Transform} transform @param {number|null} frame @param {Ground} options */
  paintBackground(ctx, transform, frame, options) {
    const style = options.mapColours;
    const corner = transform.toPane(BORDER, BORDER);
    const [width, height] = [this.size.width - 2 * BORDER, this.size.height - 2 * BORDER];
    ctx.fillStyle = style.ground;
    ctx.fillRect(corner.x, corner.y, width * transform.scale, height * transform.scale);
    this._paintMetres(ctx, transform, style, width, height);
    if (options.footprints !== false) this._paintCameras(ctx, transform, style);
  }

  paintGuides() {}

  /**
   * @param {Person} annotation @param {Look} look @param {Transform} transform @param {Options} options
   * @returns {PersonItem}
   */
  item(annotation, look, transform, options) {
    const foot = this.foot(annotation);
    const { x, y } = transform.toPane(foot.x, foot.y);
    const label = options.labelOpacity && annotation.person !== null ? String(annotation.person) : "";
    const radius = Math.max(DOT, this._scene.cylinderOf(annotation).radius * transform.scale);
    const side = Math.max(radius + 8, labelWidth(label) / 2 + 2);
    return {
      id: annotation.person,
      what: annotation,
      look: look.name,
      order: look.selected ? Infinity : 0,
      bounds: { xmin: x - side, ymin: y - radius - 26, xmax: x + side, ymax: y + radius + 8 },
      draw: (ctx) => {
        drawFoot(ctx, x, y, look, radius);
        if (look.selected) drawRing(ctx, x, y, radius + 4, look.colour);
        if (!label) return;
        ctx.globalAlpha = look.selected ? 1 : options.labelOpacity;
        drawLabel(ctx, x, y - radius - (look.selected ? 7 : 3), label, look);
        ctx.globalAlpha = 1;
      },
    };
  }

  /**
   * @param {CanvasRenderingContext2D} ctx @param {Transform} transform
   * @param {MapColours} style @param {number} width @param {number} height
   */
  _paintMetres(ctx, transform, style, width, height) {
    ctx.lineWidth = 1;
    const every = transform.scale > 12 ? 1 : 5;
    for (let metre = 0; metre <= Math.max(width, height) + 1e-9; metre += every) {
      ctx.strokeStyle = metre % 5 === 0 ? style.strong : style.weak;
      if (metre <= width) strokeLine(ctx, transform, [metre, 0], [metre, height]);
      if (metre <= height) strokeLine(ctx, transform, [0, metre], [width, metre]);
    }
  }

  /** @param {CanvasRenderingContext2D} ctx @param {Transform} transform @param {MapColours} style */
  _paintCameras(ctx, transform, style) {
    this._footprints ??= this._scene.cameras.map((camera) => footprint(camera, this._scene.grid));
    this._footprints.forEach((polygon, index) => {
      if (polygon.length < 3) return;
      const points = polygon.map((ground) => this.point(ground)).map(({ x, y }) => transform.toPane(x, y));
      drawPath(ctx, points, { colour: style.cameras[index % style.cameras.length], width: 1, closed: true });
    });
  }
}

/** @param {CanvasRenderingContext2D} ctx @param {Transform} transform @param {[number, number]} from @param {[number, number]} to */
function strokeLine(ctx, transform, [x1, y1], [x2, y2]) {
  const from = transform.toPane(x1 + BORDER, y1 + BORDER);
  const to = transform.toPane(x2 + BORDER, y2 + BORDER);
  ctx.beginPath();
  ctx.moveTo(Math.round(from.x) + 0.5, Math.round(from.y) + 0.5);
  ctx.lineTo(Math.round(to.x) + 0.5, Math.round(to.y) + 0.5);
  ctx.stroke();
}

/** @param {CanvasRenderingContext2D} ctx @param {number} x @param {number} y @param {number} radius @param {string} colour */
function drawRing(ctx, x, y, radius, colour) {
  ctx.beginPath();
  ctx.arc(x, y, radius, 0, 2 * Math.PI);
  ctx.lineWidth = 1.5;
  ctx.strokeStyle = colour;
  ctx.stroke();
}
