import { useEffect, useState } from "react";
import { intersects } from "../../../model/net/geometry";
import { spoken } from "../../../model/net/labels";
import { boxWithin, type Window } from "../../../model/net/sheets";
import type { Scene } from "./painter";

/** The list does not have more entries than this; the largest parts come first. */
const most = 60;
/** Milliseconds without a movement until the list is made. */
const rest = 250;

/** The names of what a canvas shows, for those who do not see it: a canvas has no elements that could be read. */
export function InView({ scene, window }: { scene: Scene; window: Window }) {
  const [listed, setListed] = useState<{ paths: string[]; more: number }>({ paths: [], more: 0 });
  useEffect(() => {
    const timer = setTimeout(() => setListed(partsIn(scene, window)), rest);
    return () => clearTimeout(timer);
  }, [scene, window]);
  return (
    <ul className="visually-hidden" aria-label="In view">
      {listed.paths.map((path) => (
        <li key={path}>{spoken(scene.net, path)}</li>
      ))}
      {listed.more > 0 && <li>and {listed.more} more</li>}
    </ul>
  );
}

/** The pages in the window, the largest first. */
function partsIn({ net, visible }: Scene, window: Window): { paths: string[]; more: number } {
  const found: { page: number; size: number }[] = [];
  for (const placed of visible)
    net.page(placed.page).nodes.forEach(({ page }, index) => {
      if (page === null) return;
      const box = boxWithin(placed, placed.sheet.nodes[index]!);
      if (intersects(box, window)) found.push({ page, size: box.width });
    });
  found.sort((a, b) => b.size - a.size || a.page - b.page);
  return { paths: found.slice(0, most).map(({ page }) => net.page(page).path), more: Math.max(0, found.length - most) };
}
