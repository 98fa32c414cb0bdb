import type { Box, Point } from "../net/geometry";

/** Ways of lines around boxes, in horizontal and vertical pieces: where a user has moved boxes, no layout leads them. */

export type Side = "left" | "right" | "top" | "bottom";

/** The end of a line at the rim of a box. */
export interface Rim extends Point {
  side: Side;
  /** Whether the line is inside of the box: it leaves the rim inwards. */
  inwards?: boolean;
}

/** Distances from boxes at which lines run. */
const lanes = [14, 23, 32];
const bendCost = 60;
/** The cost of a unit on which another line runs. */
const sharedCost = 6;

type Piece = readonly [Point, Point];

const outwards: Record<Side, Point> = {
  left: { x: -1, y: 0 },
  right: { x: 1, y: 0 },
  top: { x: 0, y: -1 },
  bottom: { x: 0, y: 1 },
};

/** The point in front of the rim from which the line is free. */
function before({ x, y, side, inwards }: Rim): Point {
  const by = (inwards ? -1 : 1) * lanes[0]!;
  return { x: x + outwards[side].x * by, y: y + outwards[side].y * by };
}

/** Whether a horizontal or vertical piece passes through a box; along its rim it does not. */
function hits(a: Point, b: Point, { x, y, width, height }: Box): boolean {
  const slack = 2;
  const [left, right] = [Math.min(a.x, b.x), Math.max(a.x, b.x)];
  const [top, bottom] = [Math.min(a.y, b.y), Math.max(a.y, b.y)];
  return right > x + slack && left < x + width - slack && bottom > y + slack && top < y + height - slack;
}

/** The length on which two pieces run on one line. */
function shared(a: Point, b: Point, [c, d]: Piece): number {
  const near = 4;
  if (a.y === b.y && c.y === d.y && Math.abs(a.y - c.y) < near)
    return Math.max(0, Math.min(Math.max(a.x, b.x), Math.max(c.x, d.x)) - Math.max(Math.min(a.x, b.x), Math.min(c.x, d.x)));
  if (a.x === b.x && c.x === d.x && Math.abs(a.x - c.x) < near)
    return Math.max(0, Math.min(Math.max(a.y, b.y), Math.max(c.y, d.y)) - Math.max(Math.min(a.y, b.y), Math.min(c.y, d.y)));
  return 0;
}

const sorted = (values: number[]) => [...new Set(values)].sort((a, b) => a - b);

/**
 * The points of a line between two rims that passes through no box, with few bends, and beside the lines in `others`. If
 * there is none, the line is direct.
 */
export function wayAround(from: Rim, to: Rim, boxes: readonly Box[], others: readonly (readonly Point[])[]): Point[] {
  const [start, end] = [before(from), before(to)];
  const used: Piece[] = others.flatMap((points) => points.slice(1).map((point, at): Piece => [points[at]!, point]));
  const xs = sorted([start.x, end.x, ...boxes.flatMap(({ x, width }) => lanes.flatMap((lane) => [x - lane, x + width + lane]))]);
  const ys = sorted([
    start.y,
    end.y,
    ...boxes.flatMap(({ y, height }) => lanes.flatMap((lane) => [y - lane, y + height + lane])),
  ]);
  const points = searched(xs, ys, start, end, from, boxes, used) ?? [start, { x: start.x, y: end.y }, end];
  return straightened([{ x: from.x, y: from.y }, ...points, { x: to.x, y: to.y }]);
}

interface Step {
  at: number;
  cost: number;
  rank: number;
}

/** Dijkstra with an estimate (A*) over the crossings of the lanes; a state is a crossing and the direction of arrival. */
function searched(
  xs: readonly number[],
  ys: readonly number[],
  start: Point,
  end: Point,
  { side }: Rim,
  boxes: readonly Box[],
  used: readonly Piece[],
): Point[] | undefined {
  const state = (column: number, row: number, upright: number) => (row * xs.length + column) * 2 + upright;
  const pointOf = (at: number): Point => ({ x: xs[(at >> 1) % xs.length]!, y: ys[Math.floor((at >> 1) / xs.length)]! });
  const rest = ({ x, y }: Point) => Math.abs(x - end.x) + Math.abs(y - end.y);
  const best = new Map<number, number>();
  const came = new Map<number, number>();
  const queue: Step[] = [];
  const push = (step: Step) => {
    let low = 0;
    for (let high = queue.length; low < high;) {
      const middle = (low + high) >> 1;
      if (queue[middle]!.rank > step.rank) low = middle + 1;
      else high = middle;
    }
    queue.splice(low, 0, step);
  };
  const first = state(xs.indexOf(start.x), ys.indexOf(start.y), side === "top" || side === "bottom" ? 1 : 0);
  best.set(first, 0);
  push({ at: first, cost: 0, rank: rest(start) });
  for (let step = queue.pop(); step; step = queue.pop()) {
    const { at, cost } = step;
    if (cost > best.get(at)!) continue;
    const here = pointOf(at);
    if (here.x === end.x && here.y === end.y) {
      const points = [here];
      for (let back = came.get(at); back !== undefined; back = came.get(back)) points.unshift(pointOf(back));
      return points;
    }
    const [column, row] = [(at >> 1) % xs.length, Math.floor((at >> 1) / xs.length)];
    for (const [dx, dy] of [
      [-1, 0],
      [1, 0],
      [0, -1],
      [0, 1],
    ] as const) {
      const [x, y] = [xs[column + dx], ys[row + dy]];
      if (x === undefined || y === undefined) continue;
      const there = { x, y };
      if (boxes.some((box) => hits(here, there, box))) continue;
      const upright = dy === 0 ? 0 : 1;
      const length = Math.abs(x - here.x) + Math.abs(y - here.y);
      const beside = used.reduce((sum, piece) => sum + shared(here, there, piece), 0);
      const next = cost + length + beside * sharedCost + (upright === (at & 1) ? 0 : bendCost);
      const to = state(column + dx, row + dy, upright);
      if (next >= (best.get(to) ?? Infinity)) continue;
      best.set(to, next);
      came.set(to, at);
      push({ at: to, cost: next, rank: next + rest(there) });
    }
  }
  return undefined;
}

/** Without points on straight pieces. */
function straightened(points: readonly Point[]): Point[] {
  return points.filter((point, at) => {
    const [last, next] = [points[at - 1], points[at + 1]];
    if (!last || !next) return true;
    if (last.x === point.x && last.y === point.y) return false;
    return !((last.x === point.x && point.x === next.x) || (last.y === point.y && point.y === next.y));
  });
}

const steps = [0, -1, 1, -2, 2, -3, 3, -4, 4];
const offsets = steps.flatMap((right) => steps.map((down) => [right, down] as const));

/** The middle of the longest piece of a line that a label fits on without touching a box or another label. */
export function labelOn(points: readonly Point[], { width, height }: Box, taken: readonly Box[]): Box {
  const places = points.slice(1).flatMap((b, at) => {
    const a = points[at]!;
    return [0.5, 0.3, 0.7, 0.15, 0.85].flatMap((part) =>
      // On the line, or beside it where boxes are too near.
      offsets.map(([right, down]) => {
        const by = { x: right * (width / 2 + 4), y: down * (height / 2 + 4) };
        const middle = { x: a.x + (b.x - a.x) * part + by.x, y: a.y + (b.y - a.y) * part + by.y };
        const box = { x: middle.x - width / 2, y: middle.y - height / 2, width, height };
        const crossing = taken.reduce((sum, one) => sum + covered(box, one), 0);
        return { box, cost: crossing * 1000 + 8 * Math.hypot(by.x, by.y) - Math.hypot(b.x - a.x, b.y - a.y) };
      }),
    );
  });
  return places.reduce((least, one) => (one.cost < least.cost ? one : least)).box;
}

/** The area that two boxes share. */
function covered(a: Box, b: Box): number {
  const width = Math.min(a.x + a.width, b.x + b.width) - Math.max(a.x, b.x);
  const height = Math.min(a.y + a.height, b.y + b.height) - Math.max(a.y, b.y);
  return Math.max(0, width) * Math.max(0, height);
}
