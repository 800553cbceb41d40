import { element } from "../base/dom.js";
import { gettext, ngettext } from "../base/messages.js";

/**
 * All frames of the batch in time: which are without a difference, and how many the others have.
 * @param {import("./store.js").DeskStore} store
 */
export function strip(store) {
  const buttons = [...store.frames]
    .sort((one, other) => one.frame - other.frame)
    .map((frame) => [frame.frame, frameButton(store, frame)]);
  const opened = new Set([store.current]);
  const show = () => {
    opened.add(store.current);
    for (const [number, button] of buttons) {
      if (!(button instanceof HTMLElement)) continue;
      if (number === store.current) button.setAttribute("aria-current", "true");
      else button.removeAttribute("aria-current");
      button.classList.toggle("opened", opened.has(Number(number)));
    }
  };
  store.on("frame", show);
  show();
  const row = element("div", { className: "strip-frames" });
  for (const [, button] of buttons) if (button instanceof HTMLElement) row.append(button);
  return element("nav", { className: "strip", "aria-label": gettext("Frames") }, summary(store), row);
}

/** @param {import("./store.js").DeskStore} store @param {import("./store.js").FrameJSON} frame */
function frameButton(store, { frame, differences, compared }) {
  const place = gettext("Frame {number}", { number: String(frame).padStart(8, "0") });
  const words = compared ? ngettext("{n} difference", "{n} differences", differences) : gettext("not in the reference");
  const sign = compared ? (differences ? String(differences) : "✓") : "–";
  const className = compared ? (differences ? "frame differs" : "frame clean") : "frame alone";
  return element(
    "button",
    { type: "button", className, title: `${place}: ${words}`, "data-frame": frame, onclick: () => store.open(frame) },
    element("small", {}, String(store.ordinal(frame))),
    element("span", {}, sign),
  );
}

/** @param {import("./store.js").DeskStore} store */
function summary({ frames }) {
  const compared = frames.filter((frame) => frame.compared);
  const clean = compared.filter(({ differences }) => !differences).length;
  const words = compared.length
    ? gettext("{clean} of {count} frames without a difference", { clean, count: frames.length })
    : gettext("Nothing to compare with: look at the frames (→)");
  return element("p", { className: compared.length && clean === frames.length ? "good" : "" }, words);
}
