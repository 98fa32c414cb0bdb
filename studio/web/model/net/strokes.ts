import type { NetModel } from "./net";
import type { Point, Sheet } from "./geometry";

export type ArcKind = "" | "memory" | "never";

/** The arcs of a sheet as few lines: what several arcs share is there once. */
export interface Strokes {
  /** Left, top, right, bottom of lines along an axis; one of the lengths is 0. */
  lines: Float32Array;
  /** Lines in any other direction: x, y, x, y. */
  slanted: Float32Array;
  /** Rounded corners: the points where they begin, turn and end. */
  corners: Float32Array;
  /** The ends of arcs, with the direction there: x, y, dx, dy. */
  tips: Float32Array;
}

const rounded = 7;

/** The part of a line that a corner takes. */
const cut = (from: Point, to: Point, radius: number) => {
  const length = Math.hypot(to.x - from.x, to.y - from.y);
  const part = length === 0 ? 0 : Math.min(radius, length / 2) / length;
  return { x: from.x + (to.x - from.x) * part, y: from.y + (to.y - from.y) * part };
};

/** Lines along one axis: [position across, from, to]. Those that touch each other become one. */
function merged(lines: [number, number, number][]): [number, number, number][] {
  lines.sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const found: [number, number, number][] = [];
  for (const line of lines) {
    const last = found.at(-1);
    if (last && last[0] === line[0] && line[1] <= last[2]) last[2] = Math.max(last[2], line[2]);
    else found.push([...line]);
  }
  return found;
}

const tenth = (value: number) => Math.round(value * 10) / 10;

/**
 * The lines of the arcs on a page, by their kinds. sharp: corners are not rounded. A fleet's arcs run beside each
 * other in a few lanes, so thousands of arcs become some hundred lines.
 */
export function strokesOf(net: NetModel, page: number, sheet: Sheet, sharp: boolean): ReadonlyMap<ArcKind, Strokes> {
  const { nodes, transitions } = net.page(page);
  const kinds = new Map<ArcKind, { across: [number, number, number][]; down: [number, number, number][]; rest: number[]; corners: number[]; tips: number[] }>(); // prettier-ignore
  for (const { points, transition, node } of sheet.routes) {
    if (points.length < 2) continue;
    const never = transitions[transition]?.condition?.truth === "never";
    const kind = never ? "never" : nodes[node]?.fusion !== null ? "memory" : "";
    let of = kinds.get(kind);
    if (!of) kinds.set(kind, (of = { across: [], down: [], rest: [], corners: [], tips: [] }));
    let begin = points[0]!;
    for (let at = 1; at < points.length; at += 1) {
      const [corner, next] = [points[at]!, points[at + 1]];
      const turns = !sharp && next !== undefined;
      const end = turns ? cut(corner, points[at - 1]!, rounded) : corner;
      const [x1, y1, x2, y2] = [tenth(begin.x), tenth(begin.y), tenth(end.x), tenth(end.y)];
      if (y1 === y2) of.across.push([y1, Math.min(x1, x2), Math.max(x1, x2)]);
      else if (x1 === x2) of.down.push([x1, Math.min(y1, y2), Math.max(y1, y2)]);
      else of.rest.push(x1, y1, x2, y2);
      begin = turns ? cut(corner, next, rounded) : corner;
      if (turns) of.corners.push(end.x, end.y, corner.x, corner.y, begin.x, begin.y);
    }
    const [last, before] = [points.at(-1)!, points.at(-2)!];
    of.tips.push(last.x, last.y, last.x - before.x, last.y - before.y);
  }
  return new Map(
    [...kinds].map(([kind, { across, down, rest, corners, tips }]) => [
      kind,
      {
        lines: Float32Array.from([
          ...merged(across).flatMap(([y, from, to]) => [from, y, to, y]),
          ...merged(down).flatMap(([x, from, to]) => [x, from, x, to]),
        ]),
        slanted: Float32Array.from(rest),
        corners: Float32Array.from(corners),
        tips: Float32Array.from(tips),
      },
    ]),
  );
}

/** The corners of the tip at a position of `tips`. It has the shape of the marker of single arcs. */
export function tipOf(tips: Float32Array, at: number): Point[] {
  const [x, y, along, across] = [tips[at]!, tips[at + 1]!, tips[at + 2]!, tips[at + 3]!];
  const length = Math.hypot(along, across) || 1;
  const [dx, dy] = [along / length, across / length];
  const point = (forward: number, aside: number) => ({ x: x + forward * dx - aside * dy, y: y + forward * dy + aside * dx });
  return [point(-7.6, -3.2), point(0.4, 0), point(-7.6, 3.2), point(-5.6, 0)];
}
