import { useMemo, useRef } from "react";
import type { Stage } from "../../live/stage";
import type { NetModel } from "../../model/net/net";
import type { Box } from "../../model/net/geometry";
import type { Placed, Sheets, Window } from "../../model/net/sheets";
import { crowd, isBare } from "./crowd";
import { nearness } from "../detail";
import type { SheetNode } from "./sheet_node";

/**
 * The visible sheets as nodes of the flow. An unchanged sheet stays the same object and is not drawn again.
 */
export function useNodes(
  net: NetModel,
  sheets: Sheets,
  visible: Placed[],
  window: Window,
  selected: string | null,
  flags: ReadonlyMap<string, "error" | "warning">,
  stage: Stage,
): SheetNode[] {
  const before = useRef(new Map<number, SheetNode>());
  const { zoom } = window;
  return useMemo(() => {
    const shown = new Set(visible.map((placed) => placed.page));
    const next = new Map<number, SheetNode>();
    for (const placed of visible) {
      const children = net.children(placed.page);
      const open = children.filter((child) => shown.has(child)).join();
      const folded = children.filter((child) => sheets.folded(child)).join();
      const mine = selected !== null && isOn(net, placed.page, selected) ? selected : null;
      const near = nearness(placed.scale * zoom);
      const bare = isBare(placed.sheet, placed.scale * zoom);
      const clip = !bare && placed.sheet.nodes.length > crowd ? clipOf(placed, window) : "";
      const data = { net, placed, open, folded, near, bare, clip, selected: mine, flags, stage };
      const old = before.current.get(placed.page);
      next.set(placed.page, old && alike(old, data) ? old : sheetNode(data));
    }
    before.current = next;
    return [...next.values()];
  }, [net, sheets, visible, window, selected, flags, stage]);
}

/**
 * The window with some space around it, in units of the sheet: "x,y,width,height". It changes seldom during a
 * move.
 */
function clipOf({ x, y, scale }: Placed, window: Box): string {
  const along = (from: number, length: number) => {
    const step = 2 ** (Math.ceil(Math.log2(length)) - 1);
    const first = (Math.floor(from / step) - 1) * step;
    return [first, (Math.ceil((from + length) / step) + 1) * step - first] as const;
  };
  const [left, width] = along((window.x - x) / scale, window.width / scale);
  const [top, height] = along((window.y - y) / scale, window.height / scale);
  return [left, top, width, height].join();
}

const isOn = (net: NetModel, page: number, path: string) => path.startsWith(net.page(page).path) || net.placeByName.has(path);

function alike(node: SheetNode, data: SheetNode["data"]): boolean {
  const old = node.data;
  return (
    old.net === data.net &&
    old.stage === data.stage &&
    old.open === data.open &&
    old.folded === data.folded &&
    old.near === data.near &&
    old.bare === data.bare &&
    old.clip === data.clip &&
    old.selected === data.selected &&
    old.flags === data.flags &&
    old.placed.sheet === data.placed.sheet &&
    node.position.x === data.placed.x &&
    node.position.y === data.placed.y &&
    old.placed.scale === data.placed.scale
  );
}

function sheetNode(data: SheetNode["data"]): SheetNode {
  const { page, x, y, sheet, scale } = data.placed;
  const size = { width: sheet.width * scale, height: sheet.height * scale };
  return {
    id: String(page),
    type: "sheet",
    position: { x, y },
    ...size,
    measured: size,
    data,
    zIndex: data.net.ancestry(page).length,
    style: { pointerEvents: "none" },
  };
}
