import { findThing, structureOf, withoutIndex } from "../model/structure/structure";
import type { Studio } from "./studio";

/**
 * Selects an element of the net, and shows it in the drawing that is open. The structure has no transitions: it shows
 * the behaviour or the subsystem around.
 */
export function showPlace(studio: Studio, path: string): void {
  if (studio.view.get().view === "net") return studio.flyTo(path);
  const structure = structureOf(studio.draft.text);
  for (let at = withoutIndex(path); at; at = at.slice(0, Math.max(0, at.lastIndexOf(".")))) {
    const thing = findThing(structure, at);
    if (!thing) continue;
    studio.view.set({ selected: at });
    if (thing.of.line) studio.showLine(thing.of.line);
    return;
  }
}
