import { element, setText } from "../../base/dom.js";

/**
 * @typedef {import("./store.js").Store} Store
 */

/** Events that several videos saw: choosing, marking, and setting clocks by them. */
export class Events {
  /** @param {HTMLElement} root @param {Store} store @param {(name: string) => void} act */
  constructor(root, store, act) {
    this._store = store;
    this._list = element("span", { className: "sync-group" });
    this._name = element("input", {
      type: "text",
      className: "name",
      "aria-label": "Name of the event",
      maxLength: 80,
    });
    this._name.addEventListener("change", () => store.renameEvent(this._name.value.trim()));
    this._hint = element("span", { className: "hint muted small" });
    /** @type {Map<string, HTMLButtonElement>} */
    this._buttons = new Map();
    const button = (/** @type {string} */ name, /** @type {string} */ key, /** @type {string} */ word) => {
      const made = element(
        "button",
        { type: "button", className: "small", "data-do": name, onclick: () => act(name) },
        element("kbd", {}, key),
        element("span", {}, word),
      );
      this._buttons.set(name, made);
      return made;
    };
    root.append(
      element("b", {}, "Events"),
      this._list,
      this._name,
      button("event", "N", "New"),
      button("mark", "M", "It happens here"),
      button("unmark", "Del", "Take mark away"),
      button("set", "O", "Set offsets by it"),
      button("drift", "D", "Set drift by all"),
      this._hint,
    );
  }

  draw() {
    const { _store: store } = this;
    const { events } = store.draft;
    this._list.replaceChildren(
      ...events.map((event, index) => {
        const count = Object.keys(event.marks).length;
        const title = `Marked in ${count} of ${store.clocks.length} videos`;
        const pressed = index === store.eventIndex;
        return element(
          "button",
          {
            type: "button",
            className: "small",
            title,
            "aria-pressed": pressed,
            onclick: () => store.selectEvent(index),
          },
          `${event.name} (${count})`,
        );
      }),
    );
    this._name.hidden = !store.event;
    if (document.activeElement !== this._name) this._name.value = store.event?.name ?? "";
    setText(this._word("mark"), `It happens here in ${store.clock.camera}`);
    this._enable("unmark", store.event?.marks[store.clock.file] !== undefined);
    this._enable("set", Object.keys(store.event?.marks ?? {}).length > 1);
    this._enable("drift", store.drifts.size > 0);
    setText(this._hint, hint(store));
  }

  /** @param {string} name */
  _word(name) {
    return /** @type {Node} */ (this._buttons.get(name)?.lastElementChild);
  }

  /** @param {string} name @param {boolean} possible */
  _enable(name, possible) {
    const button = this._buttons.get(name);
    if (button) button.disabled = !possible;
  }
}

/** What to do next, or what the events say about drift. @param {Store} store */
function hint(store) {
  const { event, drifts, reference } = store;
  if (!event) return "Find something sudden that several cameras saw: a ball on the ground, a door, a flash.";
  const told = store.clocks.flatMap((clock) => {
    const found = drifts.get(clock.file);
    return found ? [`${clock.camera} ${found.clock.drift.toFixed(0)} ± ${found.sigma.toFixed(0)} ppm`] : [];
  });
  if (told.length) return `Drift against ${reference.camera}: ${told.join(", ")}`;
  if (Object.keys(event.marks).length < 2) return "Choose another video and mark the same event there.";
  return `Drift: mark a second event, far from this one, here and in ${reference.camera}.`;
}
