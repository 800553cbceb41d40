/**
 * What part of which pictures shows a person. Pure.
 * @typedef {import("./pane.js").Placed} Placed
 * @typedef {import("./regions.js").Rectangle} Rectangle
 * @typedef {import("./regions.js").Size} Size
 */
const AIR = 1.35; // height of a crop, in heights of the person

/**
 * The views that show somebody best over several places: tall in the picture and not cut off at its border.
 * @param {{cameras: Size[], rectangles: (placed: Placed) => (Rectangle|null)[]}} scene @param {Placed[]} annotations
 * @param {number} count of views, at most
 * @returns {number[]} their indices
 */
export function bestViews(scene, annotations, count) {
  const scores = scene.cameras.map((camera, index) => {
    const score = annotations.reduce((sum, one) => sum + shownHeight(camera, scene.rectangles(one)[index]), 0);
    return { index, score };
  });
  return scores
    .filter(({ score }) => score > 0)
    .sort((one, other) => other.score - one.score)
    .slice(0, count)
    .map(({ index }) => index)
    .sort((one, other) => one - other);
}

/**
 * Pixels of the picture around a box, as wide as `aspect` asks for.
 * @param {Rectangle} box @param {number} aspect
 */
export function cropAround(box, aspect) {
  const height = (box.ymax - box.ymin) * AIR;
  const width = height * aspect;
  return {
    x: (box.xmin + box.xmax - width) / 2,
    y: (box.ymin + box.ymax - height) / 2,
    width,
    height,
  };
}

/**
 * Height of a box times the share of it that lies in the picture.
 * @param {Size} camera @param {Rectangle|null} box
 */
function shownHeight({ width, height }, box) {
  if (!box) return 0;
  const across = Math.min(box.xmax, width) - Math.max(box.xmin, 0);
  const down = Math.min(box.ymax, height) - Math.max(box.ymin, 0);
  const share = (Math.max(0, across) * Math.max(0, down)) / ((box.xmax - box.xmin) * (box.ymax - box.ymin));
  return share * (box.ymax - box.ymin);
}
