import { required, setText } from "../base/dom.js";
import { Saver } from "./saver.js";
import { Server } from "./server.js";

/** @typedef {{undo: string, redo: string}} Steps what both would do, in words; empty: nothing */

/** What the pages of a desk on which one clicks have in common: saving, undo and redo, and what is told of them. */
export class DeskPage {
  /**
   * @param {HTMLElement} root @param {string} api address of the desk
   * @param {string} name whose steps undo takes back @param {string} path where all of the page is asked for
   */
  constructor(root, api, name, path) {
    this.root = root;
    this.name = name;
    this.path = path;
    this.server = new Server(api, required(root, "[name=csrfmiddlewaretoken]", HTMLInputElement).value);
    this.saver = new Saver(this.server);
    this.saver.on("state", () => this._tellSaved());
    this.saver.on("answer", () => this.tell(""));
    this.saver.on("refused", (text) => this.tell(text));
    this._tellSaved();
  }

  /** @param {string} name */
  part(name) {
    return required(this.root, `[data-${name}]`, HTMLElement);
  }

  /** @param {string} text */
  tell(text) {
    this.part("problem").hidden = !text;
    setText(this.part("problem"), text);
  }

  /** @param {Steps} steps */
  showSteps(steps) {
    for (const what of /** @type {("undo"|"redo")[]} */ (["undo", "redo"])) {
      const button = required(this.root, `[data-do=${what}]`, HTMLButtonElement);
      button.disabled = !steps[what];
      button.title = steps[what] ? `${what === "undo" ? "Undo" : "Redo"}: ${steps[what]}` : "";
    }
  }

  /** Undo or redo on the server; all of the page anew, or null where it did not work. @param {"undo"|"redo"} what */
  async step(what) {
    if (!this.saver.idle) return null;
    try {
      await this.server.ask("POST", `${what}/`, { page: this.name });
      const whole = await this.server.ask("GET", this.path);
      this.tell("");
      return whole;
    } catch (error) {
      this.tell(error instanceof Error ? error.message : String(error));
      return null;
    }
  }

  _tellSaved() {
    const { idle, stuck } = this.saver;
    const waiting = stuck ? "Not saved yet: the server does not answer; trying again" : "Saving…";
    setText(this.part("saved"), idle ? "Everything is saved" : waiting);
  }
}

/** @param {Saver} saver nobody leaves before it is done without being asked */
export function holdUntilSaved(saver) {
  addEventListener("beforeunload", (event) => {
    if (!saver.idle) event.preventDefault();
  });
}
