import type { NetModel } from "../net/net";
import { boxWithin, type Sheets } from "../net/sheets";

export type Direction = "left" | "right" | "up" | "down";

/** The next element of a page in a direction; without a selection, the first element of the page. */
export function neighbour(net: NetModel, sheets: Sheets, page: number, from: string | null, direction: Direction): string | null {
  const placed = sheets.placed(page);
  if (!placed) return null;
  const elements = net.elementsOf(page).map((element) => {
    const box = element.kind === "transition" ? placed.sheet.transitions[element.index]! : placed.sheet.nodes[element.index]!;
    const at = boxWithin(placed, box);
    return { path: element.path, x: at.x + at.width / 2, y: at.y + at.height / 2 };
  });
  const here = elements.find((element) => element.path === from);
  if (!here) return elements[net.page(page).input]?.path ?? null;
  const along = direction === "left" || direction === "right" ? "x" : "y";
  const across = along === "x" ? "y" : "x";
  const sign = direction === "right" || direction === "down" ? 1 : -1;
  let best: { path: string; cost: number } | null = null;
  for (const other of elements) {
    const ahead = (other[along] - here[along]) * sign;
    if (other === here || ahead <= 0.01) continue;
    const cost = ahead + 2.2 * Math.abs(other[across] - here[across]);
    if (!best || cost < best.cost) best = { path: other.path, cost };
  }
  return best?.path ?? null;
}
