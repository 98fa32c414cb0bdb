import { useCallback, useMemo, useRef, useState } from "react";
import { useStore, useStudio } from "../hooks/use";
import type { Point } from "../model/net/geometry";
import { positionAfter, withMoved } from "../model/structure/moved_boxes";
import type { StructureDrawing } from "../model/structure/structure_graph";

interface Moved {
  drawing: StructureDrawing;
  /** Moves a box by units of the drawing, from where it was when the drag began. false: there is no such box. */
  move: (path: string, by: Point, end: boolean) => boolean;
  /** Gives up all moves; undefined: none was moved. */
  arrange: (() => void) | undefined;
}

/** The drawing with the boxes where the user has put them, also during a drag. */
export function useMoved(laidOut: StructureDrawing): Moved {
  const studio = useStudio();
  const boxes = useStore(studio.layoutFile.store, (all) => all.boxes);
  const [drag, setDrag] = useState<{ path: string; at: readonly [number, number] } | null>(null);
  const drawing = useMemo(
    () => withMoved(laidOut, drag ? { ...boxes, [drag.path]: drag.at } : boxes, drag?.path),
    [laidOut, boxes, drag],
  );
  const shown = useRef(drawing);
  shown.current = drawing;
  /** The drawing when the drag began. */
  const began = useRef<StructureDrawing | null>(null);
  const move = useCallback(
    (path: string, by: Point, end: boolean) => {
      began.current ??= shown.current;
      const at = positionAfter(began.current, path, by);
      if (!at) return false;
      if (!end) {
        setDrag({ path, at });
        return true;
      }
      began.current = null;
      setDrag(null);
      const { boxes } = studio.layoutFile.store.get();
      if (by.x !== 0 || by.y !== 0)
        studio.layoutFile.move({ before: { [path]: boxes[path] ?? null }, after: { [path]: at } }, `move ${path}`);
      return true;
    },
    [studio],
  );
  const isMoved = Object.keys(boxes).length > 0;
  return { drawing, move, arrange: isMoved ? () => studio.layoutFile.arrange() : undefined };
}
