const IDLE = 2000; // ms; of two that matter alike the one nobody has used for so long makes room

/**
 * Decoded pictures, never more than the budget. A decoded picture has four bytes per pixel whatever its file had,
 * so this, and not what was fetched, is what a page takes up.
 * @typedef {import("./images.js").Picture} Picture
 */
export class PictureShelf {
  /**
   * @param {number} budget bytes
   * @param {(picture: Picture) => number} importance of a picture: whoever has less makes room
   * @param {(picture: Picture) => void} letGo
   */
  constructor(budget, importance, letGo) {
    this._budget = budget;
    this._importance = importance;
    this._letGo = letGo;
    /** @type {Map<Picture, number>} */
    this._bytes = new Map(); // picture → bytes, of those being decoded as many as they are expected to have
  }

  get bytes() {
    return [...this._bytes.values()].reduce((sum, bytes) => sum + bytes, 0);
  }

  /**
   * Room for a picture, made by letting go less important ones; nothing is let go in vain.
   * @returns {boolean} whether there is room
   * @param {Picture} picture @param {number} bytes
   */
  take(picture, bytes) {
    this.free(picture);
    const lacking = this.bytes + bytes - this._budget;
    const leaving = this._leastImportant(picture, lacking);
    if (leaving === null) return false;
    leaving.forEach((one) => this._letGo(one));
    this._bytes.set(picture, bytes);
    return true;
  }

  /** @param {Picture} picture */
  free(picture) {
    this._bytes.delete(picture);
  }

  /**
   * Decoded pictures less important than `picture` that have so many bytes together, or null.
   * @param {Picture} picture @param {number} lacking
   */
  _leastImportant(picture, lacking) {
    const own = this._importance(picture);
    const ranked = [...this._bytes.keys()]
      .map((one) => ({ one, importance: this._importance(one) }))
      .filter(
        ({ one, importance }) =>
          one.bitmap && (importance < own || (importance === own && one.used < picture.used - IDLE)),
      )
      .sort((first, second) => first.importance - second.importance || first.one.used - second.one.used);
    /** @type {Picture[]} */
    const leaving = [];
    for (const { one } of ranked) {
      if (lacking <= 0) break;
      lacking -= this._bytes.get(one) ?? 0;
      leaving.push(one);
    }
    return lacking <= 0 ? leaving : null;
  }
}
