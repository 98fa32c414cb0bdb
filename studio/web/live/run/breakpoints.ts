import type { NetModel } from "../../model/net/net";
import type { Breakpoint } from "../../model/protocol";

/** A point at which a run pauses. It has a name, because the numbers of a net change with every edit. */
export interface NamedBreakpoint {
  /** At a token in the place, a firing of the transition, or its condition that holds. */
  on: "place" | "transition" | "condition";
  path: string;
}

export const sameBreakpoint = (one: NamedBreakpoint, other: NamedBreakpoint): boolean =>
  one.on === other.on && one.path === other.path;

export const titleOf = ({ on, path }: NamedBreakpoint): string => (on === "condition" ? `condition of ${path}` : path);

function numberIn(net: NetModel, { on, path }: NamedBreakpoint): Breakpoint | undefined {
  const index = (on === "place" ? net.placeByName : net.transitionByName).get(path);
  if (index === undefined) return undefined;
  return on === "place" ? { place: index } : on === "transition" ? { transition: index } : { condition: index };
}

/** The breakpoints in the numbers of a net, and those whose element the net does not have. */
export function numbered(net: NetModel, wanted: readonly NamedBreakpoint[]): { found: Breakpoint[]; lost: NamedBreakpoint[] } {
  const found: Breakpoint[] = [];
  const lost: NamedBreakpoint[] = [];
  for (const one of wanted) {
    const breakpoint = numberIn(net, one);
    if (breakpoint) found.push(breakpoint);
    else lost.push(one);
  }
  return { found, lost };
}
