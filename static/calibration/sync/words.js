/** Times and distances in words. Pure. */

/** Minutes, seconds and thousandths: -0:03.250, 12:07.001, 1:02:03.400. @param {number} seconds */
export function clockTime(seconds) {
  const thousandths = Math.round(Math.abs(seconds) * 1000);
  const sign = seconds < 0 && thousandths > 0 ? "−" : "";
  const [hours, minutes] = [Math.floor(thousandths / 3_600_000), Math.floor(thousandths / 60_000) % 60];
  const rest = ((thousandths % 60_000) / 1000).toFixed(3).padStart(6, "0");
  const before = hours ? `${hours}:${String(minutes).padStart(2, "0")}` : String(minutes);
  return `${sign}${before}:${rest}`;
}

/** With its sign: +38 ms, −2.400 s. @param {number} seconds */
export function signed(seconds) {
  const ms = Math.round(1000 * seconds);
  if (ms === 0) return "0 ms";
  const size = Math.abs(ms) < 10_000 ? `${Math.abs(ms)} ms` : `${Math.abs(seconds).toFixed(3)} s`;
  return `${ms < 0 ? "−" : "+"}${size}`;
}

/** How many pictures that is. @param {number} seconds @param {number} interval */
export function inPictures(seconds, interval) {
  const count = Math.round((10 * seconds) / interval) / 10;
  return `${count < 0 ? "−" : ""}${Math.abs(count)} ${Math.abs(count) === 1 ? "picture" : "pictures"}`;
}

/** @param {number} interval seconds between two pictures */
export const rate = (interval) => `${Number((1 / interval).toFixed(2))}/s`;
