import { channelPath, findThing, nextEntryOf, nextSelection, withoutIndex, type Structure, type Thing } from "./structure";

/** The ways between the elements of a structure: into one, out of it, and to the next one beside it. */

/** The element around another one, which is selected when that is removed, or left by Escape; null: the system. */
export function outside(thing: Thing): string | null {
  switch (thing.kind) {
    case "behaviour":
      return thing.of.group || thing.subsystem.path;
    case "buffer":
      return thing.subsystem.path;
    case "subsystem":
      return thing.agent.name;
    default:
      return null;
  }
}

/** The element in an element that Enter leads to; undefined: there is none. */
export function inside(structure: Structure, path: string | null): string | undefined {
  if (path === null) return structure.agents[0]?.name;
  const thing = findThing(structure, withoutIndex(path));
  switch (thing?.kind) {
    case "agent":
    case "template":
      return thing.of.subsystems[0]?.path;
    case "subsystem":
      return thing.of.behaviours[0]?.path ?? thing.of.buffers[0]?.selection;
    case "behaviour": {
      if (nextEntryOf(path) !== undefined) return undefined;
      if (thing.of.isGroup) return thing.subsystem.behaviours.find(({ group }) => group === thing.of.path)?.path;
      return thing.of.next.length > 0 ? nextSelection(thing.of.path, 0) : undefined;
    }
    case "buffer": {
      const channel = structure.channels.find(({ from, to }) => [from, to].some((end) => withoutIndex(end) === thing.of.path));
      return channel && channelPath(channel.index);
    }
    default:
      return undefined;
  }
}

export type Direction = "left" | "right" | "up" | "down";

/** A box of an element on the screen. */
export interface Shown {
  path: string;
  x: number;
  y: number;
  width: number;
  height: number;
}

/** The next box in a direction, as the arrow keys go; undefined: there is none. */
export function nextIn(boxes: readonly Shown[], from: Shown, direction: Direction): string | undefined {
  const along = direction === "left" || direction === "right" ? "x" : "y";
  const across = along === "x" ? "y" : "x";
  const size = { x: "width", y: "height" } as const;
  const sign = direction === "right" || direction === "down" ? 1 : -1;
  const middle = (one: Shown, axis: "x" | "y") => one[axis] + one[size[axis]] / 2;
  let best: { path: string; cost: number } | undefined;
  for (const one of boxes) {
    const ahead = (middle(one, along) - middle(from, along)) * sign;
    if (one.path === from.path || ahead <= 1) continue;
    const cost = ahead + 2.2 * Math.abs(middle(one, across) - middle(from, across));
    if (!best || cost < best.cost) best = { path: one.path, cost };
  }
  return best?.path;
}
