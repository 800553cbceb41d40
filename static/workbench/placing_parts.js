import { KeyRepeat } from "./keys/key_repeat.js";
import { Queue } from "./people/queue.js";
import { Arrows, directionItems } from "./placing/directions.js";
import { Dragging } from "./placing/dragging.js";
import { Ghost } from "./placing/ghost.js";
import { Guard } from "./placing/guard.js";
import { Heads } from "./placing/heads.js";
import { Moving } from "./placing/moving.js";
import { MultiViewClick } from "./placing/multi_view_click.js";
import { Sizes } from "./placing/sizes.js";

/**
 * @typedef {import("../saving/session.js").Session} Session
 * @typedef {object} Page
 * @property {import("./settings.js").Settings} settings
 * @property {import("../views/panes.js").Panes} panes
 * @property {import("../base/notices.js").Notices} notices
 */

/**
 * Whatever places people, moves them and makes them larger, each with what it needs.
 * @param {Session} session @param {Page} page
 */
export function placingParts({ scene, store, history, saver, loader }, { settings, panes, notices }) {
  const held = new KeyRepeat(settings);
  const arrows = new Arrows({ panes, settings, held });
  panes.addExtra((pane) => directionItems(panes, arrows, pane));
  const guard = new Guard({ store, saver, panes, notices });
  const heads = new Heads({ scene, notices });
  const ghost = new Ghost({ scene, store, panes, guard, settings, heads });
  const multiViewClick = new MultiViewClick({ scene, store, panes, guard });
  const moving = new Moving({ scene, store, history, guard, ghost, multiViewClick, heads, arrows, held });
  const sizes = new Sizes({ scene, store, history, guard, loader, notices });
  const dragging = new Dragging({ scene, store, panes, guard, moving, sizes });
  const queue = new Queue({ scene, store });
  return { guard, heads, ghost, moving, sizes, dragging, queue };
}
