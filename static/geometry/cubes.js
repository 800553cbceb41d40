/** 3×3 matrices, row by row. */

/** @param {number[][]} matrix */
function determinant([[a, b, c], [d, e, f], [g, h, i]]) {
  return a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g);
}

/** @param {number[][]} matrix */
export function inverse(matrix) {
  const [[a, b, c], [d, e, f], [g, h, i]] = matrix;
  const scale = 1 / determinant(matrix);
  return [
    [e * i - f * h, c * h - b * i, b * f - c * e],
    [f * g - d * i, a * i - c * g, c * d - a * f],
    [d * h - e * g, b * g - a * h, a * e - b * d],
  ].map((row) => row.map((value) => value * scale));
}

/**
 * What gives `right` when multiplied by the matrix; null where its determinant is `least` or smaller.
 * @overload @param {number[][]} matrix @param {number[]} right @returns {number[]}
 */
/**
 * @overload @param {number[][]} matrix @param {number[]} right @param {number} least @returns {number[]|null}
 */
/** @param {number[][]} matrix @param {number[]} right @param {number} [least] */
export function solve(matrix, right, least) {
  if (least !== undefined && !(determinant(matrix) > least)) return null;
  return inverse(matrix).map((row) => row.reduce((sum, value, place) => sum + value * right[place], 0));
}
