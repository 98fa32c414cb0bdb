import { useUpdateNodeInternals } from "@xyflow/react";
import { useEffect, useMemo, useState } from "react";
import { levelsOf, type Levels } from "../model/structure/levels";
import type { Structure } from "../model/structure/structure";
import { drawStructure, type StructureDrawing } from "../model/structure/structure_graph";
import { YamlText } from "../model/text/yaml_text";
import { elk } from "./elk";
import { measured } from "./measured_text";

/** A structure and its drawing, which arrives a moment after it. */
export interface Drawn {
  structure: Structure;
  drawing: StructureDrawing;
  levels: Levels;
}

export const nothing: Drawn = {
  structure: { agents: [], channels: [], system: "", types: [], yaml: new YamlText("") },
  drawing: { width: 1, height: 1, boxes: new Map(), cards: new Map(), wires: [], labels: new Map(), bundles: [] },
  levels: { agents: 0.05, subsystems: 0.27, all: 0.84 },
};

/** The last drawings by their texts: another tab and back, or an undo, lays out nothing anew. */
let last: { text: string; drawn: Promise<Drawn> }[] = [];

function drawnOf(structure: Structure): Promise<Drawn> {
  const { text } = structure.yaml;
  const known = last.find((one) => one.text === text);
  if (known) return known.drawn;
  const drawn = drawStructure(structure, elk, measured).then((drawing) => ({
    structure,
    drawing,
    levels: levelsOf(structure, drawing, measured),
  }));
  last = [{ text, drawn }, ...last].slice(0, 6);
  drawn.catch(() => (last = last.filter((one) => one.drawn !== drawn)));
  return drawn;
}

export interface DrawnState {
  drawn: Drawn;
  /** The layout of the present text is being computed. */
  busy: boolean;
  /** Why there is no layout; empty: none failed. */
  problem: string;
}

/** The drawing of the last structure with a layout. Its boxes stay in place until the next layout is ready. */
export function useDrawn(structure: Structure): DrawnState {
  const [state, setState] = useState<DrawnState>({ drawn: nothing, busy: true, problem: "" });
  useEffect(() => {
    let wanted = true;
    setState((now) => (now.drawn.structure === structure ? now : { ...now, busy: true }));
    drawnOf(structure).then(
      (drawn) => wanted && setState({ drawn, busy: false, problem: "" }),
      (error: unknown) => wanted && setState((now) => ({ ...now, busy: false, problem: String(error) })),
    );
    return () => void (wanted = false);
  }, [structure]);
  const update = useUpdateNodeInternals();
  const { drawn } = state;
  // A buffer that has moved within its box moves its handle, too.
  useEffect(() => update([...drawn.drawing.boxes.keys()]), [drawn, update]);
  return useMemo(() => state, [state]);
}
