/** Many changes, one repaint per animation frame: whoever is marked is asked to paint once. */
const waiting = new Set();

/** @param {{paint: () => void}} painter */
export function paintSoon(painter) {
  if (waiting.size === 0) requestAnimationFrame(paintAll);
  waiting.add(painter);
}

function paintAll() {
  const painters = [...waiting];
  waiting.clear();
  for (const painter of painters) {
    try {
      painter.paint();
    } catch (error) {
      reportError(error); // the others are painted all the same
    }
  }
}
