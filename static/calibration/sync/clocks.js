/**
 * What the clocks of videos say about each other. Pure; seconds, and parts per million for drift.
 * @typedef {{file: string, camera: string, offset: number, drift: number, used: boolean}} Clock
 * @typedef {{file: string, width: number, height: number, start: number, interval: number, duration: number, version: string}} Video
 * @typedef {{name: string, marks: {[file: string]: number}}} Event
 */

/** Seconds of this video in a second of the shared time. @param {Clock} clock */
export const pace = (clock) => 1 + clock.drift / 1e6;

/** The second in a video at a shared time. @param {Clock} clock @param {number} shared */
export const videoTime = (clock, shared) => clock.offset + shared * pace(clock);

/** @param {Clock} clock @param {number} at second in its video */
export const sharedTime = (clock, at) => (at - clock.offset) / pace(clock);

/** Number of the picture that is nearest, from 0. @param {Video} video @param {number} at */
export const pictureNumber = (video, at) => Math.round((at - video.start) / video.interval);

/** The instant of a picture, seconds of its video. @param {Video} video @param {number} number */
export const pictureTime = (video, number) => video.start + number * video.interval;

/** How many pictures a video has, by its header. @param {Video} video */
export const pictureCount = (video) => Math.round(video.duration / video.interval);

/** From when to when of the shared time a video lasts. @param {Clock} clock @param {Video} video */
export const extent = (clock, video) => ({
  from: sharedTime(clock, video.start),
  until: sharedTime(clock, video.start + video.duration),
});

/**
 * What all of them see. Where `until` is before `from` they share nothing: `last` begins when `first` is over.
 * @param {{clock: Clock, video: Video}[]} pairs at least one
 */
export function overlap(pairs) {
  const spans = pairs.map(({ clock, video }) => ({ camera: clock.camera, ...extent(clock, video) }));
  const last = spans.reduce((a, b) => (b.from > a.from ? b : a));
  const first = spans.reduce((a, b) => (b.until < a.until ? b : a));
  return { from: last.from, until: first.until, last: last.camera, first: first.camera };
}

/**
 * By how many seconds of the shared time an event comes later in this video than in the reference; null where it
 * is not marked in both.
 * @param {Event} event @param {Clock} clock @param {Clock} reference
 */
export function apart(event, clock, reference) {
  const [here, there] = [event.marks[clock.file], event.marks[reference.file]];
  if (here === undefined || there === undefined) return null;
  return sharedTime(clock, here) - sharedTime(reference, there);
}

/** Its clock so that an event is at the same shared time as in the reference. @param {Event} event @param {Clock} clock @param {Clock} reference */
export function setBy(event, clock, reference) {
  const later = apart(event, clock, reference);
  return later === null ? clock : { ...clock, offset: fine(clock.offset + later * pace(clock)) };
}

/**
 * Offset and drift out of the events marked in both, two or more; `sigma`: how sure the drift is, parts per million,
 * for an event lies somewhere between two pictures.
 * @param {Event[]} events @param {Clock} clock @param {Clock} reference @param {Video} video @param {Video} of the reference
 * @returns {{clock: Clock, sigma: number}|null} null where two do not tell a drift
 */
export function driftBy(events, clock, reference, video, of) {
  const both = events.filter(({ marks }) => marks[clock.file] !== undefined && marks[reference.file] !== undefined);
  const xs = both.map(({ marks }) => sharedTime(reference, marks[reference.file]));
  const ys = both.map(({ marks }) => marks[clock.file]);
  const [x0, y0] = [mean(xs), mean(ys)];
  const spread = xs.reduce((sum, x) => sum + (x - x0) ** 2, 0);
  if (both.length < 2 || spread < 1) return null;
  const slope = xs.reduce((sum, x, at) => sum + (x - x0) * (ys[at] - y0), 0) / spread;
  const sigma = Math.hypot(video.interval, of.interval) / Math.sqrt(12 * spread);
  const drift = Math.round(1e8 * (slope - 1)) / 100;
  return { clock: { ...clock, drift, offset: fine(y0 - x0 * (1 + drift / 1e6)) }, sigma: 1e6 * sigma };
}

/** All clocks as they are told from this one: its offset and drift become 0. @param {Clock[]} clocks @param {Clock} reference */
export function toldFrom(clocks, reference) {
  return clocks.map((clock) => {
    const share = pace(clock) / pace(reference);
    const offset = clock.offset - share * reference.offset;
    return { ...clock, offset: fine(offset), drift: Math.round(1e8 * (share - 1)) / 100 };
  });
}

/** A hundredth of a millisecond is finer than any picture. @param {number} seconds */
export const fine = (seconds) => Math.round(1e5 * seconds) / 1e5;

/** @param {number[]} values */
function mean(values) {
  return values.reduce((sum, value) => sum + value, 0) / Math.max(values.length, 1);
}
