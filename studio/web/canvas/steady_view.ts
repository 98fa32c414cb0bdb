import { useReactFlow, useStore, type ReactFlowState } from "@xyflow/react";
import { useEffect, useRef } from "react";
import { overlap, type Box } from "../model/net/geometry";

const windowOf = (state: ReactFlowState) => [...state.transform, state.width, state.height].join();

/**
 * Keeps the visible part of the drawing in view when its space changes, for example when a
 * panel opens below it, and restores the old view when the space returns. Panes that follow
 * another one are moved with it.
 */
export function useSteadyView(drawing: Box | undefined, lead = true): void {
  const flow = useReactFlow();
  const [x, y, zoom, width, height] = useStore(windowOf).split(",").map(Number) as [number, number, number, number, number];
  const seen = useRef<{ box: Box; zoom: number; width: number; height: number } | null>(null);
  const own = useRef("");
  useEffect(() => {
    if (width === 0 || height === 0 || !drawing) return;
    const last = seen.current;
    if (last && lead && (last.width !== width || last.height !== height)) {
      const { box } = last;
      seen.current = { ...last, width, height };
      const near = Math.min(last.zoom, width / box.width, height / box.height);
      const to = { x: width / 2 - (box.x + box.width / 2) * near, y: height / 2 - (box.y + box.height / 2) * near, zoom: near };
      own.current = [to.x, to.y, to.zoom].join();
      void flow.setViewport(to);
    } else if (own.current !== [x, y, zoom].join()) {
      const window = { x: -x / zoom, y: -y / zoom, width: width / zoom, height: height / zoom };
      seen.current = { box: overlap(window, drawing) ?? window, zoom, width, height };
    }
  }, [flow, drawing, lead, x, y, zoom, width, height]);
}
