import { HALO, INK } from "../../views/styles.js";

const COLOUR = "#ffb26b";
const RADIUS = 8; // CSS pixels of the sign
const ABOVE = 14; // over the feet's place, so that the foot itself is seen

/**
 * Items for `Panes.addExtra`: a sign where the reviewer's open comments of this frame belong.
 * @typedef {import("./comments.js").Comment} Comment
 * @typedef {Pick<import("./comments.js").Parts, "scene"|"store">} Parts
 * @typedef {import("../../views/pane.js").LaidOutPane} LaidOutPane
 * @param {Comment[]} comments @param {Parts} parts @param {LaidOutPane} pane
 */
export function commentItems(comments, { scene, store }, pane) {
  return comments
    .filter(({ frame, resolved }) => frame === store.current && !resolved)
    .flatMap((comment) => {
      const position = (comment.person === null ? null : store.person(comment.person)?.position) ?? comment.position;
      const point = position === null ? null : pane.view.point(scene.metres(position));
      if (!point) return [];
      const { x, y } = pane.transform.toPane(point.x, point.y);
      // From above there is no foot to stand over: beside the person.
      return [item(comment, pane.view.index === null ? { x: x + ABOVE + 4, y: y + ABOVE } : { x, y })];
    });
}

/** @param {Comment} comment @param {{x: number, y: number}} place */
function item(comment, { x, y }) {
  const bounds = { xmin: x - 10, ymin: y - ABOVE - 10, xmax: x + 10, ymax: y + 4 };
  return {
    id: `comment ${comment.id}`,
    what: comment,
    look: "comment",
    bounds,
    draw: (/** @type {CanvasRenderingContext2D} */ ctx) => {
      ctx.setLineDash([]);
      ctx.beginPath();
      ctx.arc(x, y - ABOVE, RADIUS, 0, 2 * Math.PI);
      ctx.lineWidth = 2.5;
      ctx.strokeStyle = HALO;
      ctx.stroke();
      ctx.fillStyle = COLOUR;
      ctx.fill();
      ctx.fillStyle = INK;
      ctx.font = "700 11px system-ui, 'DejaVu Sans', sans-serif";
      ctx.textAlign = "center";
      ctx.textBaseline = "middle";
      ctx.fillText("…", x, y - ABOVE);
    },
  };
}
