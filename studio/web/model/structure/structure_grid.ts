import type { Box, Point } from "../net/geometry";

/**
 * Places agents in a grid, and leads the trunks between them through lanes: vertical ones between the
 * columns, horizontal ones between the rows. Agents with common channels stand near each other, and a ring of
 * agents becomes a ring, because that is the shortest way.
 */

export interface Trunk {
  id: string;
  agents: readonly [string, string];
  /** Indices of the channels that it carries. */
  channels: number[];
  /** The size of their labels, one above the other. */
  label: { width: number; height: number };
}

/** The point where a trunk leaves an agent. */
export interface End {
  trunk: string;
  side: "WEST" | "EAST";
  /** Height that it takes at the rim. */
  room: number;
}

interface Cell {
  column: number;
  row: number;
}

export interface Grid {
  columns: number;
  rows: number;
  cells: ReadonlyMap<string, Cell>;
  /** From above to below, on each side. */
  ends(agent: string): End[];
}

interface Sized {
  name: string;
  width: number;
  height: number;
}

/** The shape of a window that the drawing should fill: width by height. */
const shape = 1.25;
const lanePitch = 18;
const plainRoom = 18;

export function placed(agents: readonly Sized[], trunks: readonly Trunk[]): Grid {
  let best: { cells: Map<string, Cell>; columns: number; rows: number; zoom: number } | undefined;
  const circle = circleOf(agents, trunks);
  const widest = Math.max(1, ...agents.map(({ width }) => width));
  const tallest = Math.max(1, ...agents.map(({ height }) => height));
  for (let columns = 1; columns <= agents.length; columns += 1) {
    const rows = Math.ceil(agents.length / columns);
    const gap = 120 + (trunks.length * lanePitch) / columns;
    const zoom = Math.min(shape / (columns * (widest + gap)), 1 / (rows * (tallest + 60)));
    if (best && zoom <= best.zoom) continue;
    if (circle.length === 0) best = { cells: arranged(agents, trunks, columns), columns, rows, zoom };
    else if (columns === 2 || rows === 2) best = { cells: around(circle, columns, rows), columns, rows, zoom };
  }
  const { cells = new Map<string, Cell>(), columns = 0, rows = 0 } = best ?? {};
  return { cells, columns, rows, ends: (agent) => endsOf(agent, cells, trunks) };
}

/** The agents of a ring in its order; empty: they form none. */
function circleOf(agents: readonly Sized[], trunks: readonly Trunk[]): string[] {
  const beside = (name: string) => trunks.flatMap(({ agents: [a, b] }) => (a === name ? [b] : b === name ? [a] : []));
  if (agents.length < 3 || agents.some(({ name }) => beside(name).length !== 2)) return [];
  const way = [agents[0]!.name];
  for (let next: string | undefined = beside(way[0]!)[0]; next !== undefined;) {
    way.push(next);
    next = beside(next).find((name) => !way.includes(name));
  }
  return way.length === agents.length ? way : [];
}

/** A ring in two rows or two columns. */
function around(circle: readonly string[], columns: number, rows: number): Map<string, Cell> {
  const half = Math.max(columns, rows);
  return new Map(
    circle.map((name, at) => {
      const [along, across] = at < half ? [at, 0] : [2 * half - 1 - at - (2 * half - circle.length), 1];
      const there = Math.max(0, along);
      return [name, rows === 2 ? { column: there, row: across } : { column: across, row: there }];
    }),
  );
}

/** Exchanges agents as long as the trunks become shorter. */
function arranged(agents: readonly Sized[], trunks: readonly Trunk[], columns: number): Map<string, Cell> {
  const names = agents.map(({ name }) => name);
  const cellAt = (at: number): Cell => ({ column: at % columns, row: Math.floor(at / columns) });
  const positions = new Map(names.map((name, at) => [name, at]));
  const length = () =>
    trunks.reduce((sum, { agents: [one, other], channels }) => {
      const [a, b] = [cellAt(positions.get(one)!), cellAt(positions.get(other)!)];
      const [across, down] = [Math.abs(a.column - b.column), Math.abs(a.row - b.row)];
      return sum + channels.length * (across + down + (across > 0 && down > 0 ? 0.5 : 0));
    }, 0);
  const exchange = (one: string, other: string) => {
    const at = positions.get(one)!;
    positions.set(one, positions.get(other)!);
    positions.set(other, at);
  };
  // Beyond this number, the way of all trunks costs more than it is worth.
  for (let better = names.length <= 60, now = length(); better;) {
    better = false;
    for (let i = 0; i < names.length; i += 1)
      for (let j = i + 1; j < names.length; j += 1) {
        exchange(names[i]!, names[j]!);
        const then = length();
        if (then < now - 1e-9) [now, better] = [then, true];
        else exchange(names[i]!, names[j]!);
      }
  }
  return new Map([...positions].map(([name, at]) => [name, cellAt(at)]));
}

/** The agent on the left of a trunk, or above within a column; its label is there. */
function firstOf(trunk: Trunk, cells: ReadonlyMap<string, Cell>): readonly [string, string] {
  const [one, other] = trunk.agents;
  const [a, b] = [cells.get(one)!, cells.get(other)!];
  return a.column < b.column || (a.column === b.column && a.row <= b.row) ? [one, other] : [other, one];
}

function endsOf(agent: string, cells: ReadonlyMap<string, Cell>, trunks: readonly Trunk[]): End[] {
  const here = cells.get(agent);
  if (!here) return [];
  return trunks
    .filter(({ agents }) => agents.includes(agent))
    .map((trunk) => {
      const [first, second] = firstOf(trunk, cells);
      const other = cells.get(first === agent ? second : first)!;
      const side: End["side"] = other.column >= here.column ? "EAST" : "WEST";
      return {
        end: { trunk: trunk.id, side, room: first === agent ? trunk.label.height + 4 : plainRoom },
        row: other.row,
        column: other.column,
      };
    })
    .sort((a, b) => a.row - b.row || Math.abs(a.column - here.column) - Math.abs(b.column - here.column))
    .map(({ end }) => end);
}

interface Placed {
  box: Box;
  /** The points where trunks meet the rim, from the upper left corner of the agent. */
  ports: ReadonlyMap<string, Point>;
}

interface Routed {
  size: { width: number; height: number };
  agents: Map<string, Box>;
  /** first: the agent at which the points begin. */
  trunks: { id: string; first: string; points: Point[]; label: Box }[];
}

/** Lines that share the space between two columns or rows; those that do not meet share a lane. */
class Lanes {
  private readonly taken: { from: number; to: number; lane: number }[] = [];

  take(one: number, other: number): number {
    const [from, to] = [Math.min(one, other) - lanePitch, Math.max(one, other) + lanePitch];
    for (let lane = 0; ; lane += 1) {
      if (this.taken.some((known) => known.lane === lane && known.from < to && from < known.to)) continue;
      this.taken.push({ from, to, lane });
      return lane;
    }
  }

  get count(): number {
    return Math.max(0, ...this.taken.map(({ lane }) => lane + 1));
  }
}

/** Leads the trunks through the lanes, in the order in which they cross each other least. */
export function routed(grid: Grid, trunks: readonly Trunk[], inside: (agent: string) => Placed): Routed {
  const shifts = shiftsOf(grid, inside);
  let best: { routed: Routed; cost: number } | undefined;
  for (const order of orders(trunks)) {
    const one = routedInOrder(grid, order, inside, shifts);
    const cost = crossings(one.trunks.map(({ points }) => points));
    if (!best || cost < best.cost) best = { routed: one, cost };
  }
  return best!.routed;
}

/** Orders in which trunks may take lanes. They are always the same ones, so that a text has one drawing. */
function* orders(trunks: readonly Trunk[]): Generator<readonly Trunk[]> {
  yield trunks;
  if (trunks.length < 2) return;
  yield [...trunks].reverse();
  const tries = trunks.length > 60 ? 2 : 60;
  let seed = 1;
  const random = (below: number) => (seed = (seed * 48271) % 2147483647) % below;
  for (let at = 0; at < tries; at += 1) {
    const order = [...trunks];
    for (let last = order.length - 1; last > 0; last -= 1) {
      const other = random(last + 1);
      [order[last], order[other]] = [order[other]!, order[last]!];
    }
    yield order;
  }
}

/** How often lines cross each other. */
function crossings(lines: readonly (readonly Point[])[]): number {
  const pieces = lines.map((points) => points.slice(1).map((to, at) => ({ from: points[at]!, to })));
  const between = (value: number, one: number, other: number) => value > Math.min(one, other) && value < Math.max(one, other);
  let count = 0;
  pieces.forEach((own, at) =>
    pieces.slice(at + 1).forEach((others) => {
      for (const a of own)
        for (const b of others) {
          const [flat, upright] = a.from.y === a.to.y ? [a, b] : [b, a];
          if (flat.from.y !== flat.to.y || upright.from.x !== upright.to.x) continue;
          const crosses = between(upright.from.x, flat.from.x, flat.to.x) && between(flat.from.y, upright.from.y, upright.to.y);
          count += Number(crosses);
        }
    }),
  );
  return count;
}

/** Lines that begin at both sides of a space have at least this distance. */
const apart = 9;
const mostShift = 36;

/**
 * Moves agents down a little, so that no two trunks meet in the space between two neighbours: they would look like one
 * line. A trunk between both becomes straight, if possible.
 */
function shiftsOf({ cells }: Grid, inside: (agent: string) => Placed): Map<string, number> {
  const shifts = new Map<string, number>();
  const inOrder = [...cells].sort(([, a], [, b]) => a.row - b.row || a.column - b.column);
  for (const [agent, { column, row }] of inOrder) {
    const left = inOrder.find(([, cell]) => cell.row === row && cell.column === column - 1)?.[0];
    if (left === undefined) {
      shifts.set(agent, 0);
      continue;
    }
    const { box, ports: there } = inside(left);
    const theirs = [...there].filter(([, { x }]) => x >= box.width / 2).map(([id, { y }]) => ({ id, y: y + shifts.get(left)! }));
    const own = [...inside(agent).ports].filter(([, { x }]) => x < 1).map(([id, { y }]) => ({ id, y }));
    const straight = own.flatMap(({ id, y }) => theirs.filter((one) => one.id === id).map((one) => one.y - y));
    const steps = Array.from({ length: mostShift / 3 + 1 }, (_, at) => at * 3);
    const cost = (shift: number) =>
      own.reduce((sum, { id, y }) => {
        const near = theirs.filter((one) => one.id !== id && Math.abs(one.y - y - shift) < apart).length;
        const aligned = theirs.some((one) => one.id === id && Math.abs(one.y - y - shift) < 0.01);
        return sum + near - Number(aligned) * 0.5;
      }, shift / 1000);
    const possible = [...steps, ...straight.filter((shift) => shift >= 0 && shift <= mostShift)];
    shifts.set(
      agent,
      possible.reduce((best, shift) => (cost(shift) < cost(best) ? shift : best)),
    );
  }
  return shifts;
}

function routedInOrder(
  grid: Grid,
  trunks: readonly Trunk[],
  inside: (agent: string) => Placed,
  shifts: ReadonlyMap<string, number>,
): Routed {
  const { cells, columns, rows } = grid;
  const ways = trunks.map((trunk) => wayOf(trunk, grid));
  const least = (count: number) => Array.from({ length: count }, () => 0);
  const widths = least(columns);
  const heights = least(rows);
  for (const [agent, { column, row }] of cells) {
    const { width, height } = inside(agent).box;
    widths[column] = Math.max(widths[column]!, width);
    heights[row] = Math.max(heights[row]!, height + shifts.get(agent)!);
  }
  // Horizontal lanes: the space below row r. Their number determines the positions of the rows.
  const level = Array.from({ length: rows }, () => new Lanes());
  const levelOf = new Map(ways.map((way) => [way.id, way.below === null ? 0 : level[way.below]!.take(way.left, way.right)]));
  const tops: number[] = [];
  let y = 0;
  for (let row = 0; row < rows; row += 1) {
    tops.push(y);
    y += heights[row]! + 60 + level[row]!.count * lanePitch;
  }
  // Vertical lanes: the space on the right of column c.
  const heightAt = (agent: string, trunk: string) =>
    tops[cells.get(agent)!.row]! + shifts.get(agent)! + inside(agent).ports.get(trunk)!.y;
  const levelAt = ({ id, below }: Way) => tops[below!]! + heights[below!]! + 30 + levelOf.get(id)! * lanePitch;
  const upright = Array.from({ length: columns }, () => new Lanes());
  const laneOf = new Map<string, [number, number]>();
  for (const way of ways) {
    const [start, end] = [heightAt(way.first, way.id), heightAt(way.second, way.id)];
    const middle = way.below === null ? end : levelAt(way);
    const one = upright[way.left]!.take(start, middle);
    laneOf.set(way.id, [one, way.below === null ? one : upright[way.right]!.take(middle, end)]);
  }
  const labelRoom = least(columns).map((_, column) =>
    Math.max(0, ...ways.filter(({ left }) => left === column).map(({ id }) => trunks.find((one) => one.id === id)!.label.width)),
  );
  const lefts: number[] = [];
  let x = 0;
  for (let column = 0; column < columns; column += 1) {
    lefts.push(x);
    x += widths[column]! + gapOf(labelRoom[column]!, upright[column]!.count);
  }
  const agents = new Map<string, Box>();
  for (const [agent, { column, row }] of cells)
    agents.set(agent, { ...inside(agent).box, x: lefts[column]!, y: tops[row]! + shifts.get(agent)! });
  const laneAt = (column: number, lane: number) =>
    lefts[column]! + widths[column]! + 22 + labelRoom[column]! + 14 + lane * lanePitch;
  const drawn = ways.map((way) => {
    const rim = (agent: string): Point => {
      const [box, port] = [agents.get(agent)!, inside(agent).ports.get(way.id)!];
      return { x: box.x + port.x, y: box.y + port.y };
    };
    const [from, to] = [rim(way.first), rim(way.second)];
    const [one, other] = laneOf.get(way.id)!.map((lane, at) => laneAt(at === 0 ? way.left : way.right, lane)) as [number, number];
    const { label } = trunks.find(({ id }) => id === way.id)!;
    const bends =
      way.below === null
        ? [
            { x: one, y: from.y },
            { x: one, y: to.y },
          ]
        : [
            { x: one, y: from.y },
            { x: one, y: levelAt(way) },
            { x: other, y: levelAt(way) },
            { x: other, y: to.y },
          ];
    const points = [from, ...bends, to];
    return { id: way.id, first: way.first, points, label: { x: from.x + 14, y: from.y - label.height / 2 + 1, ...label } };
  });
  return { size: { width: x, height: y }, agents, trunks: drawn };
}

const gapOf = (label: number, lanes: number) => (lanes === 0 ? 30 : 22 + label + 14 + lanes * lanePitch + 26);

interface Way {
  id: string;
  first: string;
  second: string;
  /** The vertical spaces that it uses, by the column on their left. */
  left: number;
  right: number;
  /** The horizontal space between them, by the row above it; null: it needs none. */
  below: number | null;
}

function wayOf(trunk: Trunk, { cells }: Grid): Way {
  const [first, second] = firstOf(trunk, cells);
  const [a, b] = [cells.get(first)!, cells.get(second)!];
  const near = b.column <= a.column + 1;
  const right = b.column === a.column ? a.column : b.column - 1;
  return { id: trunk.id, first, second, left: a.column, right, below: near ? null : Math.min(a.row, b.row) };
}
