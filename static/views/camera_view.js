import { screenAxes } from "../geometry/directions.js";
import { gridLines, gridOutline } from "../geometry/ground.js";
import { boxBounds, drawBox, drawFoot, drawPath } from "./marks.js";
import { CYAN } from "./styles.js";

const FULL_FROM = 1.15; // screen pixels per light pixel from which full resolution is worth its bytes

/**
 * What one camera sees. A view knows its source coordinates (image pixels) and draws with a pane's transform.
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
 * @typedef {import("./images.js").Images} Images
 * @typedef {import("./pane.js").View} View
 * @implements {View}
 */
export class CameraView {
  /** @param {Scene} scene @param {number} index @param {Images} images */
  constructor(scene, index, images) {
    const camera = scene.cameras[index];
    this.id = `camera-${index}`;
    this.index = index;
    this.title = camera.name;
    this.byTable = Boolean(camera.byTable); // of a model that this page does not know
    this.size = { width: camera.width, height: camera.height };
    this.largest = 8; // CSS pixels per image pixel
    this._scene = scene;
    this._images = images;
    /** @type {XY[][]|null} */
    this._outline = null;
    /** @type {XY[][]|null} */
    this._lines = null;
  }

  /** @param {XY} point @param {number} [z] metres @returns {XY|null} */
  ground(point, z = 0) {
    return this._scene.toGround(this.index, point, z);
  }

  /**
   * Where a ground point is seen, or null.
   * @param {XY} ground @returns {XY|null}
   */
  point(ground) {
    return this._scene.toImage(this.index, ground);
  }

  /** @param {Placed} annotation @returns {XY|null} */
  foot(annotation) {
    return this.point(this._scene.metres(annotation.position));
  }

  /** @param {Placed} annotation @returns {Rectangle|null} */
  box(annotation) {
    return this._scene.rectangles(annotation)[this.index];
  }

  /** What each arrow key does there. @param {Placed} annotation @returns {Axes|null} */
  axes(annotation) {
    const { x, y } = this._scene.metres(annotation.position);
    return screenAxes(this._scene.cameras[this.index], x, y);
  }

  /**
   * The picture to show for a frame, sharp enough for the transform.
   * @param {number} frame @param {Transform} transform @param {number} ratio
   */
  picture(frame, transform, ratio) {
    const lightWidth = this._images.peek(frame, this.index, "light")?.width ?? this.size.width;
    const needed = (transform.scale * ratio * this.size.width) / lightWidth;
    return this._images.show(frame, this.index, needed >= FULL_FROM && lightWidth < this.size.width);
  }

  /** @param {number} frame */
  retry(frame) {
    this._images.retry(frame, this.index);
  }

  /**
   * @param {CanvasRenderingContext2D} ctx @param {Transform} transform @param {number} frame
   * @param {Options} options @param {number} ratio
   */
  paintBackground(ctx, transform, frame, options, ratio) {
    const { bitmap } = this.picture(frame, transform, ratio);
    if (!bitmap) return;
    ctx.imageSmoothingEnabled = transform.scale * ratio < 4; // single pixels become visible when magnified
    ctx.drawImage(
      bitmap,
      transform.left,
      transform.top,
      this.size.width * transform.scale,
      this.size.height * transform.scale,
    );
  }

  /** @param {CanvasRenderingContext2D} ctx @param {Transform} transform @param {Options} options */
  paintGuides(ctx, transform, options) {
    if (options.grid) {
      this._lines ??= gridLines(this._scene.cameras[this.index], this._scene.grid, 1);
      for (const line of this._lines) {
        drawPath(ctx, onPane(line, transform), {
          colour: "rgba(255, 255, 255, 0.6)",
          width: 0.75,
          rim: "rgba(6, 12, 18, 0.15)",
        });
      }
    }
    if (options.outline) {
      this._outline ??= gridOutline(this._scene.cameras[this.index], this._scene.grid);
      for (const line of this._outline) drawPath(ctx, onPane(line, transform), { colour: CYAN, dash: [8, 5] });
    }
  }

  /**
   * What to draw for one visible person.
   * @param {Person} annotation @param {Look} look @param {Transform} transform @param {Options} options
   * @returns {PersonItem}
   */
  item(annotation, look, transform, options) {
    const seen = this.box(annotation);
    if (!seen) throw new TypeError("somebody who is not visible cannot be drawn");
    const box = paneBox(seen, transform);
    const label = options.labelOpacity && annotation.person !== null ? String(annotation.person) : "";
    const opacity = look.selected ? { box: 1, label: 1 } : { box: options.boxOpacity, label: options.labelOpacity };
    const foot = look.selected ? this.foot(annotation) : null;
    return {
      id: annotation.person,
      what: annotation,
      look: look.name,
      order: look.selected ? Infinity : box.ymax,
      bounds: boxBounds(box, label),
      draw: (ctx) => {
        drawBox(ctx, box, look, label, opacity);
        if (foot) {
          const { x, y } = transform.toPane(foot.x, foot.y);
          drawFoot(ctx, x, y, look, 3);
        }
      },
    };
  }
}

/** @param {Rectangle} box @param {Transform} transform */
function paneBox(box, transform) {
  const { x: xmin, y: ymin } = transform.toPane(box.xmin, box.ymin);
  const { x: xmax, y: ymax } = transform.toPane(box.xmax, box.ymax);
  return { xmin, ymin, xmax, ymax };
}

/** @param {XY[]} points @param {Transform} transform */
function onPane(points, transform) {
  return points.map(({ x, y }) => transform.toPane(x, y));
}
