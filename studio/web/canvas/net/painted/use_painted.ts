import { useEffect, useState } from "react";
import { useStore } from "../../../hooks/use";
import { foldedPage, intersects, place, type Box } from "../../../model/net/geometry";
import { windowOn, type Placed, type Window } from "../../../model/net/sheets";
import { crowd } from "../crowd";
import { vectors } from "./vectors";

/** A drawing of more elements of SVG than this is on a canvas: a browser takes too long for them in each frame. */
const most = 1000;
/** Milliseconds without a movement until a drawing of few symbols is made of elements again. */
const rest = 180;

/** The elements of SVG that symbols.tsx makes of a place, a folded page, an open one, a bar. */
const parts = { place: 7, folded: 6, open: 14, bar: 5 };

/** Elements are made for the space around the window, too (sheet_nodes.ts). */
const withSpace = ({ x, y, width, height }: Box): Box => ({ x: x - width, y: y - height, width: 3 * width, height: 3 * height });

/** About as many elements of SVG as the visible sheets need. */
export function elementsIn(visible: readonly Placed[], window: Window): number {
  let found = 0;
  for (const placed of visible) {
    const { nodes, transitions, routes } = placed.sheet;
    const own = withSpace(windowOn(placed, window));
    const isDrawn = nodes.length > crowd ? (box: Box) => intersects(box, own) : () => true;
    for (const box of nodes)
      if (isDrawn(box)) found += box.width === place ? parts.place : box.width === foldedPage ? parts.folded : parts.open;
    found += parts.bar * transitions.length + (nodes.length > crowd ? 0 : routes.length);
  }
  return found;
}

/**
 * Whether a drawing is on a canvas. It goes there at once when there is too much to see, and back only when the view
 * rests, because making elements takes longer than a frame.
 */
export function usePainted(elements: number, window: Window): boolean {
  const wanted = useStore(vectors, (all) => all.wanted > 0);
  const [painted, setPainted] = useState(false);
  const crowded = elements > most;
  useEffect(() => {
    if (crowded) return setPainted(true);
    if (!painted) return;
    const timer = setTimeout(() => setPainted(false), rest);
    return () => clearTimeout(timer);
  }, [crowded, painted, window]);
  return !wanted && (crowded || painted);
}
