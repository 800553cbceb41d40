/** What `benchmarks.effort` runs in the page: a scripted annotator at the real workbench. */
import { Annotator } from "./effort_annotator.js";
import { Hands } from "./effort_hands.js";
import { openWorkbench } from "./effort_session.js";
import { SheetAnnotator } from "./effort_sheet.js";

/** @param {{scene: object, truth: Object<string, number>[], plan: object, seed: number}} job */
export async function work({ scene, truth, plan, seed, proposed }) {
  const { session, panes, sheet } = await openWorkbench(scene, proposed);
  const Kind = plan.sheet ? SheetAnnotator : Annotator;
  const annotator = new Kind(session, new Hands(session, panes, plan, seed), truth, plan);
  annotator.sheet = sheet;
  await annotator.run();
  return annotator.report();
}
