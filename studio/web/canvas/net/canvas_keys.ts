import type { useReactFlow } from "@xyflow/react";
import type { KeyboardEvent } from "react";
import type { Stage } from "../../live/stage";
import type { Studio } from "../../live/studio";
import { neighbour, type Direction } from "../../model/structure/neighbour";
import type { NetModel } from "../../model/net/net";
import type { Sheets } from "../../model/net/sheets";
import { shortcutOf } from "../../model/shortcuts";

interface KeyContext {
  net: NetModel;
  sheets: Sheets;
  selected: string | null;
  current: number;
  studio: Studio;
  stage: Stage;
  flow: ReturnType<typeof useReactFlow>;
}

const directions = { left: "left", right: "right", up: "up", down: "down" } as const satisfies Record<string, Direction>;

/** Handles a key on the drawing; false: the key has no function there. */
export function canvasKey(event: KeyboardEvent, context: KeyContext): boolean {
  const { net, sheets, selected, current, studio, stage, flow } = context;
  // Buttons within the drawing keep their keys.
  if (event.target instanceof HTMLButtonElement) return false;
  const pressed = shortcutOf("net", event);
  const page = selected === null ? undefined : net.pageByPath.get(selected);
  switch (pressed) {
    case undefined:
      return false;
    case "left":
    case "right":
    case "up":
    case "down": {
      const on = (selected === null ? undefined : net.find(selected)?.page) ?? current;
      const next = neighbour(net, sheets, on, selected, directions[pressed]);
      if (next !== null) studio.select(next);
      return true;
    }
    case "enter": {
      const transition = selected === null ? undefined : net.transitionByName.get(selected);
      if (transition !== undefined && stage.mode === "game") return studio.play.choose(transition);
      if (page === undefined) return false;
      if (sheets.folded(page)) studio.fold(selected!, false);
      studio.fly(selected!);
      const first = net.elementsOf(page)[net.page(page).input];
      if (first && !sheets.folded(page)) studio.select(first.path);
      return true;
    }
    case "leave": {
      const up = net.page(current).parent ?? 0;
      studio.select(current === 0 ? null : net.page(current).path);
      studio.fly(net.page(up).path);
      return true;
    }
    case "fold":
      if (page === undefined) return false;
      studio.fold(selected!, !sheets.folded(page));
      return true;
    case "nearer":
      void flow.zoomIn();
      return true;
    case "farther":
      void flow.zoomOut();
      return true;
    case "whole":
      studio.fly("");
      return true;
  }
}
