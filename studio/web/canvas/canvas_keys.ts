import type { useReactFlow } from "@xyflow/react";
import type { KeyboardEvent } from "react";
import type { Stage } from "../live/stage";
import type { Studio } from "../live/studio";
import { neighbour, type Direction } from "../model/structure/neighbour";
import type { NetModel } from "../model/net/net";
import type { Sheets } from "../model/net/sheets";

interface KeyContext {
  net: NetModel;
  sheets: Sheets;
  selected: string | null;
  current: number;
  studio: Studio;
  stage: Stage;
  flow: ReturnType<typeof useReactFlow>;
}

const directions: Record<string, Direction> = { ArrowLeft: "left", ArrowRight: "right", ArrowUp: "up", ArrowDown: "down" };

/** Handles a key on the drawing; false: the key has no function there. */
export function canvasKey(event: KeyboardEvent, context: KeyContext): boolean {
  const { net, sheets, selected, current, studio, stage, flow } = context;
  // Keys of the browser, and of buttons within the drawing, keep their function.
  if (event.ctrlKey || event.metaKey || event.altKey || event.target instanceof HTMLButtonElement) return false;
  const direction = directions[event.key];
  if (direction) {
    const on = (selected === null ? undefined : net.find(selected)?.page) ?? current;
    const next = neighbour(net, sheets, on, selected, direction);
    if (next !== null) studio.select(next);
    return true;
  }
  const page = selected === null ? undefined : net.pageByPath.get(selected);
  switch (event.key) {
    case "Enter":
    case " ": {
      const transition = selected === null ? undefined : net.transitionByName.get(selected);
      if (transition !== undefined && stage.mode === "game") return studio.play.choose(transition);
      if (page === undefined) return false;
      if (sheets.folded(page)) studio.fold(selected!, false);
      studio.fly(selected!);
      const first = net.elementsOf(page)[net.page(page).input];
      if (first && !sheets.folded(page)) studio.select(first.path);
      return true;
    }
    case "Escape":
    case "Backspace": {
      const up = net.page(current).parent ?? 0;
      studio.select(current === 0 ? null : net.page(current).path);
      studio.fly(net.page(up).path);
      return true;
    }
    case "f":
      if (page === undefined) return false;
      studio.fold(selected!, !sheets.folded(page));
      return true;
    case "+":
    case "=":
      void flow.zoomIn();
      return true;
    case "-":
      void flow.zoomOut();
      return true;
    case "0":
      studio.fly("");
      return true;
    default:
      return false;
  }
}
