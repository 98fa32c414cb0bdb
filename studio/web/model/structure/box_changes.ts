import type { Positions } from "./moved_boxes";

type Position = readonly [number, number];

/** A change of moved boxes, by path; null: the box is where the layout puts it. */
export interface BoxChange {
  before: Record<string, Position | null>;
  after: Record<string, Position | null>;
}

export const reversed = ({ before, after }: BoxChange): BoxChange => ({ before: after, after: before });

/** One change, then another. */
export const both = (first: BoxChange | undefined, second: BoxChange): BoxChange =>
  first ? { before: { ...second.before, ...first.before }, after: { ...first.after, ...second.after } } : second;

/** The boxes after a change. */
export function withChange(boxes: Positions, { after }: BoxChange): Positions {
  const now: Record<string, Position> = { ...boxes };
  for (const [path, at] of Object.entries(after))
    if (at) now[path] = at;
    else delete now[path];
  return now;
}

const same = (a: Position | undefined, b: Position | undefined) => a?.[0] === b?.[0] && a?.[1] === b?.[1];

/** The boxes that are elsewhere, or moved in one of both only. */
export const differing = (a: Positions, b: Positions): string[] =>
  [...new Set([...Object.keys(a), ...Object.keys(b)])].filter((path) => !same(a[path], b[path]));

/** The boxes that two sides have moved since `base`. The place of `mine` counts for a box that both have moved. */
export function joined(base: Positions, mine: Positions, theirs: Positions): Positions {
  const all = new Set([...Object.keys(base), ...Object.keys(mine), ...Object.keys(theirs)]);
  const now: Record<string, Position> = {};
  for (const path of all) {
    const at = same(mine[path], base[path]) ? theirs[path] : mine[path];
    if (at) now[path] = at;
  }
  return now;
}
