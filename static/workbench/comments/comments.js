import { element } from "../../base/dom.js";
import { gettext, ngettext } from "../../base/messages.js";
import { commentItems } from "./comment_marks.js";

/**
 * What the reviewer wrote about the batch, on top of the side panel. A click goes to the frame and the person; the
 * worker answers, and says what is done.
 * @typedef {{id: number, frame: number|null, person: number|null, position: number|null, text: string, role: string,
 *            resolved: boolean, answers?: Comment[]}} Comment as the server sends it
 * @typedef {object} Parts
 * @property {import("../../base/api.js").Api} api
 * @property {import("../../truth/scene.js").Scene} scene
 * @property {import("../../truth/store.js").Store} store
 * @property {import("../../views/panes.js").Panes} panes
 * @property {{jump: (number: number) => Promise<unknown>}} navigation
 * @property {import("../../base/notices.js").Notices} notices
 */
export class Comments {
  /** @param {Parts} parts */
  constructor(parts) {
    this._parts = parts;
    /** @type {Comment[]} */
    this.all = [];
    this._heading = element("h2", {});
    this._list = element("ul", {});
    this.element = element(
      "section",
      { className: "comments", "aria-label": gettext("Comments of the reviewer"), hidden: true },
      this._heading,
      this._list,
    );
    parts.panes.addExtra((pane) => commentItems(this.all, parts, pane));
    parts.store.on("frame", () => this._markHere());
    this._ask("GET", "comments/");
  }

  /** @param {Comment[]} comments */
  _show(comments) {
    this.all = comments;
    const open = comments.filter(({ resolved }) => !resolved).length;
    this.element.hidden = !comments.length;
    this._heading.textContent = open
      ? ngettext("{n} comment to look at", "{n} comments to look at", open)
      : gettext("All comments are done: submit the batch again");
    this._list.replaceChildren(...comments.map((comment) => this._row(comment)));
    this._markHere();
    this._parts.panes.markPeople(true);
  }

  /** @param {Comment} comment */
  _row(comment) {
    const answers = (comment.answers ?? []).map(({ role, text }) =>
      element("p", { className: "answer" }, `${role === "worker" ? gettext("You") : gettext("Reviewer")}: ${text}`),
    );
    const done = element(
      "button",
      { type: "button", onclick: () => this._resolve(comment) },
      comment.resolved ? gettext("✓ done") : gettext("Done"),
    );
    const row = element(
      "li",
      { className: comment.resolved ? "resolved" : "", "data-frame": String(comment.frame ?? "") },
      this._where(comment),
      element("p", {}, comment.text),
      ...answers,
      this._parts.scene.editable ? element("div", { className: "row" }, done, this._answering(comment)) : "",
    );
    return row;
  }

  /** @param {Comment} comment */
  _where(comment) {
    const words = [
      comment.frame === null ? gettext("Whole batch") : gettext("Frame {frame}", { frame: this._frameName(comment) }),
      comment.person === null ? "" : gettext("person {person}", { person: comment.person }),
    ];
    return element(
      "button",
      { type: "button", className: "where", disabled: comment.frame === null, onclick: () => this._go(comment) },
      words.filter(Boolean).join(", "),
    );
  }

  /** Frames are counted from 1, as on the timeline. @param {Comment} comment */
  _frameName({ frame }) {
    return String(this._parts.scene.frames.findIndex(({ number }) => number === frame) + 1);
  }

  /** Enter sends. @param {Comment} comment */
  _answering(comment) {
    const field = element("input", {
      type: "text",
      maxLength: 2000,
      placeholder: gettext("Answer"),
      "aria-label": gettext("Answer"),
    });
    field.addEventListener("keydown", (event) => {
      event.stopPropagation(); // letters are keys of the workbench elsewhere
      if (event.key === "Escape") field.blur();
      if (event.key !== "Enter" || !field.value.trim()) return;
      this._ask("POST", "comments/", { text: field.value, answers: comment.id });
    });
    return field;
  }

  /** @param {Comment} comment */
  async _go({ frame, person }) {
    if (frame === null) return;
    const { navigation, store, panes } = this._parts;
    await navigation.jump(frame);
    if (store.current !== frame) return; // it could not be loaded
    store.select(person !== null && store.person(person) ? person : null);
    panes.zoom(store.selection !== null);
  }

  /** @param {Comment} comment */
  _resolve(comment) {
    return this._ask("POST", `comments/${comment.id}/`, { resolved: !comment.resolved });
  }

  _markHere() {
    for (const row of this._list.children) {
      if (!(row instanceof HTMLElement)) continue;
      row.classList.toggle("here", row.dataset.frame === String(this._parts.store.current));
    }
  }

  /** @param {string} method @param {string} path @param {object} [body] */
  async _ask(method, path, body) {
    const { api, notices } = this._parts;
    /** @type {Record<string, string>} */
    const headers = { ...api.headers(), Accept: "application/json" };
    if (body) headers["Content-Type"] = "application/json";
    const options = { method, headers, cache: /** @type {const} */ ("no-store"), body: body && JSON.stringify(body) };
    const answer = await fetch(api.base + path, options).catch(() => null);
    const content = await answer?.json().catch(() => null);
    if (answer?.ok) this._show(content.comments);
    else notices.say(content?.message ?? gettext("The comments could not be reached. Try again"));
  }
}
