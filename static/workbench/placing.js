import { Arrows, directionItems } from "./directions.js";
import { Dragging } from "./dragging.js";
import { Ghost } from "./ghost.js";
import { Guard } from "./guard.js";
import { Heads } from "./heads.js";
import { Held } from "./held.js";
import { Moving } from "./moving.js";
import { Sightings } from "./sightings.js";
import { Sizes } from "./sizes.js";
import { Tour } from "./tour.js";

/** Whatever places people, moves them and makes them larger, each with what it needs. */
export function placingParts({ scene, store, history, saver, loader }, { settings, panes, notices }) {
  const held = new Held(settings);
  const arrows = new Arrows({ panes, settings, held });
  panes.addExtra((pane) => directionItems(panes, arrows, pane));
  const guard = new Guard({ store, saver, panes, notices });
  const heads = new Heads({ scene, notices });
  const ghost = new Ghost({ scene, store, panes, guard, settings, heads });
  const sightings = new Sightings({ scene, store, panes, guard });
  const moving = new Moving({ scene, store, history, guard, ghost, sightings, heads, arrows, held });
  const sizes = new Sizes({ scene, store, history, guard, loader, notices });
  const dragging = new Dragging({ scene, store, panes, guard, moving, sizes });
  const tour = new Tour({ scene, store });
  return { guard, heads, ghost, moving, sizes, dragging, tour };
}
