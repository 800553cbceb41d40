import { screenAxes } from "../geometry/directions.js";
import { gridLines, gridOutline } from "../geometry/ground.js";
import { boxBounds, drawBox, drawFoot, drawPath } from "./marks.js";
import { CYAN } from "./styles.js";

const FULL_FROM = 1.15; // screen pixels per light pixel from which full resolution is worth its bytes

/** What one camera sees. A view knows its source coordinates (image pixels) and draws with a pane's transform. */
export class CameraView {
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
    this._outline = null;
    this._lines = null;
  }

  ground(point, z = 0) {
    return this._scene.toGround(this.index, point, z);
  }

  /** Where a ground point is seen, or null. */
  point(ground) {
    return this._scene.toImage(this.index, ground);
  }

  foot(annotation) {
    return this.point(this._scene.metres(annotation.position));
  }

  box(annotation) {
    return this._scene.rectangles(annotation)[this.index];
  }

  /** What each arrow key does there: {left: {columns, rows}, right, up, down}, or null. */
  axes(annotation) {
    const { x, y } = this._scene.metres(annotation.position);
    return screenAxes(this._scene.cameras[this.index], x, y);
  }

  /** The picture to show for a frame, sharp enough for the transform. */
  picture(frame, transform, ratio) {
    const lightWidth = this._images.peek(frame, this.index, "light")?.width ?? this.size.width;
    const needed = (transform.scale * ratio * this.size.width) / lightWidth;
    return this._images.show(frame, this.index, needed >= FULL_FROM && lightWidth < this.size.width);
  }

  retry(frame) {
    this._images.retry(frame, this.index);
  }

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

  /** What to draw for one visible person. */
  item(annotation, look, transform, options) {
    const box = paneBox(this.box(annotation), transform);
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

function paneBox(box, transform) {
  const { x: xmin, y: ymin } = transform.toPane(box.xmin, box.ymin);
  const { x: xmax, y: ymax } = transform.toPane(box.xmax, box.ymax);
  return { xmin, ymin, xmax, ymax };
}

function onPane(points, transform) {
  return points.map(({ x, y }) => transform.toPane(x, y));
}
