import { useStore as useFlow, type Node } from "@xyflow/react";
import { useStore, useStudio } from "../../hooks/use";
import type { Box } from "../../model/net/geometry";

/** The small map with the visible part: it is of use while a part of the drawing is out of sight. */
export interface StructureMap {
  useful: boolean;
  shown: boolean;
}

/** Pixels of a drawing that has space for a map beside what is worked on. */
const roomy = { width: 600, height: 420 };

export function useMap(whole: Box): StructureMap {
  const chosen = useStore(useStudio().view, (view) => view.map);
  const useful = useFlow(({ transform: [x, y, zoom], width, height }) => {
    const margin = 4;
    const [left, top] = [x + whole.x * zoom, y + whole.y * zoom];
    const across = left >= -margin && left + whole.width * zoom <= width + margin;
    const down = top >= -margin && top + whole.height * zoom <= height + margin;
    return !(across && down);
  });
  const large = useFlow(({ width, height }) => width >= roomy.width && height >= roomy.height);
  return { useful, shown: useful && (chosen ?? large) };
}

export const mapClass = (node: Node) => (node.type === "agent" ? "map-agent" : "map-part");

/** The map lies over a corner of the drawing, so it can be put away. */
export function MapToggle({ map: { useful, shown } }: { map: StructureMap }) {
  const studio = useStudio();
  if (!useful) return null;
  return (
    <button
      className="quiet"
      title="A map of the whole system in the corner of the drawing"
      onClick={() => studio.view.set({ map: !shown })}
    >
      {shown ? "Hide the map" : "Map"}
    </button>
  );
}
