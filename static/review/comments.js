import { element } from "../base/dom.js";
import { gettext } from "../base/messages.js";

/**
 * The comments on the batch: where, what, what the worker answered. A click goes there.
 * @typedef {import("./server.js").CommentJSON} CommentJSON
 */
export class CommentList {
  /**
   * @param {CommentJSON[]} comments
   * @param {{go: (comment: CommentJSON) => void, resolve: (comment: CommentJSON) => void,
   *          ordinal: (frame: number) => number}} parts
   */
  constructor(comments, parts) {
    this._parts = parts;
    this._list = element("ul", { className: "comments" });
    this._heading = element("h2", {});
    this.element = element("section", { className: "comments-part" }, this._heading, this._list);
    this.show(comments);
  }

  /** @param {CommentJSON[]} comments */
  show(comments) {
    this.comments = comments;
    this.element.hidden = comments.length === 0;
    this._heading.textContent = gettext("Comments: {n}", { n: comments.length });
    this._list.replaceChildren(...comments.map((comment) => this._row(comment)));
  }

  /** @param {CommentJSON} comment */
  _row(comment) {
    const { go, resolve, ordinal } = this._parts;
    const answers = (comment.answers ?? []).map(({ role, text }) => {
      const who = role === "worker" ? gettext("Worker") : gettext("Reviewer");
      return element("p", { className: "answer" }, `${who}: ${text}`);
    });
    return element(
      "li",
      { className: comment.resolved ? "resolved" : "" },
      element("button", { type: "button", className: "where", onclick: () => go(comment) }, where(comment, ordinal)),
      element("span", {}, comment.text),
      ...answers,
      element(
        "button",
        { type: "button", className: "done", onclick: () => resolve(comment) },
        comment.resolved ? gettext("✓ done") : gettext("Done"),
      ),
    );
  }
}

/** @param {CommentJSON} comment @param {(frame: number) => number} ordinal */
function where({ frame, person }, ordinal) {
  if (frame === null) return gettext("Whole batch");
  if (person === null) return gettext("Frame {frame}", { frame: ordinal(frame) });
  return gettext("Frame {frame}, person {person}", { frame: ordinal(frame), person });
}
