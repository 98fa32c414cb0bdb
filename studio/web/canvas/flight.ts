import { useReactFlow } from "@xyflow/react";
import { useEffect, useRef } from "react";
import { useStore, useStudio } from "../hooks/use";
import type { Box } from "../model/net/geometry";
import type { Sheets } from "../model/net/sheets";

const still = matchMedia("(prefers-reduced-motion: reduce)");

/**
 * Flies to the target of a request as soon as the sheets on the way are there.
 * Unfolds the pages on the way.
 */
export function useFlight(sheets: Sheets, version: number, lead: boolean): void {
  const studio = useStudio();
  const flow = useReactFlow();
  const flight = useStore(studio.view, (view) => view.flight);
  const done = useRef(0);
  useEffect(() => {
    const element = flight && sheets.net.find(flight.path);
    if (!lead || !flight || !element || flight.request === done.current) return;
    const closed = sheets.net.ancestry(element.page).filter((page) => page !== 0 && sheets.folded(page));
    if (closed.length > 0)
      return studio.foldMany(
        closed.map((page) => sheets.net.page(page).path),
        false,
      );
    const box = sheets.boxOf(flight.path);
    if (!box) return;
    done.current = flight.request;
    const open = element.kind === "page" && (element.index < 0 || !sheets.folded(sheets.net.pageByPath.get(flight.path)!));
    void flow.fitBounds(open ? box : wider(box, 9), { duration: still.matches ? 0 : 350, padding: 0.06 });
  }, [flight, sheets, version, lead, flow, studio]);
}

const wider = (box: Box, times: number): Box => {
  const size = Math.max(box.width, box.height) * times;
  return { x: box.x + box.width / 2 - size / 2, y: box.y + box.height / 2 - size / 2, width: size, height: size };
};
