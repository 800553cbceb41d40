/**
 * Source pixels (an image, or the map's metres) → CSS pixels of a pane: x' = x·scale + left. Immutable.
 * @typedef {import("./regions.js").Size} Size
 * @typedef {import("./regions.js").Rectangle} Rectangle
 */
export class Transform {
  /** @param {number} scale @param {number} left @param {number} top */
  constructor(scale, left, top) {
    if (!(scale > 0)) throw new RangeError(`scale must be positive, not ${scale}`);
    this.scale = scale;
    this.left = left;
    this.top = top;
  }

  /** @param {number} x @param {number} y */
  toPane(x, y) {
    return { x: x * this.scale + this.left, y: y * this.scale + this.top };
  }

  /** @param {number} x @param {number} y */
  toSource(x, y) {
    return { x: (x - this.left) / this.scale, y: (y - this.top) / this.scale };
  }

  /**
   * Zoom by `factor`, keeping the source point under pane point (x, y) where it is.
   * @param {number} factor @param {number} x @param {number} y
   */
  zoomAt(factor, x, y) {
    const scale = this.scale * factor;
    return new Transform(scale, x - (x - this.left) * factor, y - (y - this.top) * factor);
  }

  /** @param {number} dx @param {number} dy */
  moved(dx, dy) {
    return new Transform(this.scale, this.left + dx, this.top + dy);
  }

  /** @param {Transform} other */
  equals(other) {
    return this.scale === other.scale && this.left === other.left && this.top === other.top;
  }
}

/**
 * The whole source inside the pane, centred.
 * @param {Size} source @param {Size} pane
 */
export function fit(source, pane) {
  const scale = Math.min(pane.width / source.width, pane.height / source.height);
  return centred(scale, source.width / 2, source.height / 2, pane);
}

/**
 * Source rectangle `box` in the middle of the pane, filling at most `share` of it.
 * @param {Rectangle} box @param {Size} pane @param {number} share @param {number} limit of the scale
 */
export function focus(box, pane, share, limit) {
  const width = Math.max(box.xmax - box.xmin, 1e-6);
  const height = Math.max(box.ymax - box.ymin, 1e-6);
  const scale = Math.min((pane.width * share) / width, (pane.height * share) / height, limit);
  return centred(scale, (box.xmin + box.xmax) / 2, (box.ymin + box.ymax) / 2, pane);
}

/**
 * Never smaller than fitting, never scrolled off: some of the source always stays in sight.
 * @param {Transform} transform @param {Size} source @param {Size} pane @param {number} limit of the scale
 */
export function clamped(transform, source, pane, limit) {
  const smallest = Math.min(pane.width / source.width, pane.height / source.height);
  if (transform.scale <= smallest) return fit(source, pane);
  const scale = Math.min(transform.scale, limit);
  const again =
    scale === transform.scale ? transform : transform.zoomAt(scale / transform.scale, pane.width / 2, pane.height / 2);
  return new Transform(
    scale,
    clampOffset(again.left, source.width * scale, pane.width),
    clampOffset(again.top, source.height * scale, pane.height),
  );
}

/**
 * In a pane of another size: the same place in the middle, as much larger as the pane.
 * @param {Transform} transform @param {Size} before @param {Size} after
 */
export function resized(transform, before, after) {
  const { x, y } = transform.toSource(before.width / 2, before.height / 2);
  const factor = Math.min(after.width / before.width, after.height / before.height);
  return centred(transform.scale * factor, x, y, after);
}

/** @param {number} offset @param {number} length @param {number} room */
function clampOffset(offset, length, room) {
  const slack = room / 2; // a foot at the border of an image can still be brought to the middle
  return Math.min(slack, Math.max(room - length - slack, offset));
}

/** @param {number} scale @param {number} x @param {number} y @param {Size} pane */
function centred(scale, x, y, pane) {
  return new Transform(scale, pane.width / 2 - x * scale, pane.height / 2 - y * scale);
}
