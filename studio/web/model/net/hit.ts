import { foldedPage, textWidth, type Box, type Point } from "./geometry";
import type { Folded } from "./layout";
import type { NetModel } from "./net";
import type { Placed } from "./sheets";

const inside = (box: Box, { x, y }: Point, rim = 0) =>
  x >= box.x - rim && x <= box.x + box.width + rim && y >= box.y - rim && y <= box.y + box.height + rim;

/** A transition is thin: the space around it belongs to it, too. */
const reach = 6;

/** The name of a symbol is beside it, or below it. */
function onName(box: Box, name: string, direction: "down" | "right", { x, y }: Point): boolean {
  const length = 6 + 6.2 * name.length;
  const [cx, cy] = [box.x + box.width / 2, box.y + box.height / 2];
  if (direction === "down") return x >= cx && x <= box.x + box.width + length && Math.abs(y - cy) <= 9;
  const across = Math.max(box.width, length) / 2;
  return Math.abs(x - cx) <= across && y >= cy && y <= box.y + box.height + 20;
}

/**
 * The path of the element that is drawn at a point of the drawing; null: none is. visible: the drawn sheets,
 * parents first.
 */
export function elementAt(net: NetModel, folded: Folded, visible: readonly Placed[], point: Point): string | null {
  for (let at = visible.length - 1; at >= 0; at -= 1) {
    const { page, sheet, x, y, scale } = visible[at]!;
    const local = { x: (point.x - x) / scale, y: (point.y - y) / scale };
    if (!inside({ x: 0, y: 0, width: sheet.width, height: sheet.height }, local, foldedPage)) continue;
    const found = elementOn(net, folded, page, sheet, local);
    if (found !== null) return found;
  }
  return null;
}

function elementOn(net: NetModel, folded: Folded, page: number, sheet: Placed["sheet"], at: Point): string | null {
  const { nodes, transitions } = net.page(page);
  const bar = sheet.transitions.findIndex((box) => inside(box, at, reach));
  if (bar >= 0) return net.transitions.at(net.flatTransitions(page)[bar]!)?.name ?? transitions[bar]!.name;
  const hit = sheet.nodes.findIndex((box) => inside(box, at));
  const node = hit >= 0 ? hit : named();
  if (node < 0) return null;
  const child = nodes[node]!.page;
  if (child !== null) return net.page(child).path;
  return net.places.at(net.flatPlaces(page)[node]!)?.name ?? nodes[node]!.name;

  function named(): number {
    return sheet.nodes.findIndex((box, index) => {
      const { name, page: child } = nodes[index]!;
      if (child !== null && !folded(child)) return false;
      if (Math.abs(at.x - box.x) > box.width + textWidth(name) + 40) return false;
      return onName(box, name, child !== null && sheet.grid ? "right" : sheet.direction, at);
    });
  }
}
