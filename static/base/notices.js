import { element } from "./dom.js";

const SHOWN = 3200; // ms

/**
 * Short messages: at the bottom, or beside the place they are about. All are also read out by screen readers.
 */
export class Notices {
  constructor() {
    this._live = element("div", { className: "visually-hidden", role: "status", "aria-live": "polite" });
    this._bottom = element("div", { className: "notices" });
    this._beside = element("div", { className: "notice beside", hidden: true });
    /** @type {number|undefined} */
    this._timer = undefined;
    this.element = element("div", {}, this._live, this._bottom, this._beside);
  }

  /** @param {string} text */
  say(text) {
    this._read(text);
    const notice = element("div", { className: "notice" }, text);
    this._bottom.replaceChildren(notice);
    setTimeout(() => notice.remove(), SHOWN);
  }

  /** @param {{x: number, y: number} | null} place in CSS pixels of the window @param {string} text */
  sayAt(place, text) {
    if (!place) return this.say(text);
    this._read(text);
    this._beside.textContent = text;
    this._beside.hidden = false;
    const { width, height } = this._beside.getBoundingClientRect();
    const left = Math.max(4, Math.min(place.x + 14, window.innerWidth - width - 4));
    const top = place.y + 18 + height > window.innerHeight ? place.y - height - 12 : place.y + 18;
    this._beside.style.translate = `${left}px ${Math.max(4, top)}px`;
    clearTimeout(this._timer);
    this._timer = setTimeout(() => (this._beside.hidden = true), SHOWN);
  }

  /**
   * Silent on the screen, heard by screen readers.
   * @param {string} text
   */
  _read(text) {
    this._live.textContent = text;
  }
}
