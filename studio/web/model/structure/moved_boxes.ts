import type { Box, Point } from "../net/geometry";
import { agentHead } from "./levels";
import type { StructureDrawing } from "./structure_graph";
import { labelOn, wayAround, type Rim, type Side } from "./way_around";

/**
 * A drawing with boxes where a user has put them. The boxes of agents stand where they were put; those of subsystems are
 * told from the corner of their agent, so that they move with it. Boxes that were not moved make room. Lines are led anew
 * where they must.
 */

/** By path of an agent or subsystem. */
export type Positions = Readonly<Record<string, readonly [number, number]>>;

const rim = 26;
/** Least spaces between subsystems, and between agents: layouts leave more. */
const between = { subsystems: 20, agents: 28 };

const isSubsystem = (path: string) => path.includes(".") && !path.includes("#");
const agentOf = (path: string) => path.split(".")[0]!;
const deviceOf = (path: string) => `${path}#device`;

const overlaps = (a: Box, b: Box, gap: number) =>
  a.x < b.x + b.width + gap && b.x < a.x + a.width + gap && a.y < b.y + b.height + gap && b.y < a.y + a.height + gap;

interface Piece {
  path: string;
  box: Box;
  moved: boolean;
}

/** The same boxes without overlaps: those that were moved stay, the others go to the right or below, whichever is nearer. */
function apart(pieces: readonly Piece[], gap: number, first: string | undefined): Map<string, Box> {
  const rank = ({ path, moved }: Piece) => (path === first ? 0 : moved ? 1 : 2);
  const order = [...pieces].sort((a, b) => rank(a) - rank(b) || a.box.y - b.box.y || a.box.x - b.box.x);
  const placed = new Map<string, Box>();
  for (const { path, box } of order) {
    const free = (axis: "x" | "y", size: "width" | "height"): Box => {
      let at = box;
      for (let found = true; found;) {
        found = false;
        for (const other of placed.values()) {
          if (!overlaps(at, other, gap)) continue;
          at = { ...at, [axis]: other[axis] + other[size] + gap };
          found = true;
        }
      }
      return at;
    };
    const [right, below] = [free("x", "width"), free("y", "height")];
    placed.set(path, right.x - box.x <= below.y - box.y ? right : below);
  }
  return placed;
}

/** A subsystem with the device below it. */
function withDevice(boxes: ReadonlyMap<string, Box>, path: string): Box {
  const [box, device] = [boxes.get(path)!, boxes.get(deviceOf(path))];
  if (!device) return box;
  const x = Math.min(box.x, device.x);
  const right = Math.max(box.x + box.width, device.x + device.width);
  return { x, y: box.y, width: right - x, height: device.y + device.height - box.y };
}

/** The places of the boxes. */
function movedBoxes({ boxes }: StructureDrawing, moved: Positions, first: string | undefined): Map<string, Box> {
  const agents = [...boxes.keys()].filter((path) => !path.includes("."));
  const insides = new Map<string, Map<string, Box>>();
  const pieces = agents.map((path): Piece => {
    const agent = boxes.get(path)!;
    const own = [...boxes.keys()].filter((one) => isSubsystem(one) && agentOf(one) === path);
    const parts = own.map((one): Piece => {
      const [whole, box] = [withDevice(boxes, one), boxes.get(one)!];
      const hang = box.x - whole.x;
      const at = moved[one];
      const x = at ? Math.max(rim, at[0] - hang) : whole.x - agent.x;
      const y = at ? Math.max(agentHead + 6, at[1]) : whole.y - agent.y;
      return { path: one, box: { ...whole, x, y }, moved: at !== undefined };
    });
    const changed = parts.some((one) => one.moved);
    const inside = changed ? apart(parts, between.subsystems, first) : new Map(parts.map((one) => [one.path, one.box]));
    insides.set(path, inside);
    const far = (of: (box: Box) => number, least: number) => Math.max(least, ...[...inside.values()].map((box) => of(box) + rim));
    const size = changed
      ? { width: far((box) => box.x + box.width, agent.width), height: far((box) => box.y + box.height, agent.height) }
      : { width: agent.width, height: agent.height };
    const at = moved[path];
    return { path, box: { x: at?.[0] ?? agent.x, y: at?.[1] ?? agent.y, ...size }, moved: at !== undefined };
  });
  const grown = pieces.some(({ path, box }) => {
    const { x, y, width, height } = boxes.get(path)!;
    return box.x !== x || box.y !== y || box.width !== width || box.height !== height;
  });
  const placed = grown
    ? apart(pieces, between.agents, first && agentOf(first))
    : new Map(pieces.map(({ path, box }) => [path, box]));
  const all = new Map<string, Box>();
  for (const path of agents) {
    const agent = placed.get(path)!;
    all.set(path, agent);
    for (const [one, box] of insides.get(path)!) {
      const [before, whole] = [boxes.get(one)!, withDevice(boxes, one)];
      const by = { x: agent.x + box.x - whole.x, y: agent.y + box.y - whole.y };
      const shifted = ({ x, y, ...size }: Box): Box => ({ x: x + by.x, y: y + by.y, ...size });
      all.set(one, shifted(before));
      const device = boxes.get(deviceOf(one));
      if (device) all.set(deviceOf(one), shifted(device));
    }
  }
  return all;
}

/** The box on whose rim a line ends, and the side; undefined: it ends nowhere. */
function rimAt(
  point: Point,
  boxes: ReadonlyMap<string, Box>,
  paths: readonly string[],
): { path: string; side: Side } | undefined {
  const slack = 3;
  for (const path of paths) {
    const { x, y, width, height } = boxes.get(path)!;
    const alongX = point.x > x - slack && point.x < x + width + slack;
    const alongY = point.y > y - slack && point.y < y + height + slack;
    const sides: Record<Side, boolean> = {
      left: alongY && Math.abs(point.x - x) < slack,
      right: alongY && Math.abs(point.x - x - width) < slack,
      top: alongX && Math.abs(point.y - y) < slack,
      bottom: alongX && Math.abs(point.y - y - height) < slack,
    };
    const side = (Object.keys(sides) as Side[]).find((one) => sides[one]);
    if (side) return { path, side };
  }
  return undefined;
}

/**
 * The drawing after moves. first: a box that is being moved, for which all others make room.
 *
 * Shape: a search over the lanes beside the boxes for each line that is led anew.
 */
export function withMoved(drawing: StructureDrawing, moved: Positions, first?: string): StructureDrawing {
  const old = drawing.boxes;
  if (!Object.keys(moved).some((path) => old.has(path))) return drawing;
  const boxes = movedBoxes(drawing, moved, first);
  const agents = [...old.keys()].filter((path) => !path.includes("."));
  const parts = [...old.keys()].filter((path) => path.includes("."));
  const by = (path: string): Point => ({ x: boxes.get(path)!.x - old.get(path)!.x, y: boxes.get(path)!.y - old.get(path)!.y });
  const same = (a: Point, b: Point) => Math.abs(a.x - b.x) < 0.01 && Math.abs(a.y - b.y) < 0.01;
  const isStiff = (agent: string) => {
    const [before, after] = [old.get(agent)!, boxes.get(agent)!];
    const own = parts.filter((path) => agentOf(path) === agent);
    return before.width === after.width && before.height === after.height && own.every((path) => same(by(path), by(agent)));
  };
  const stiff = new Set(agents.filter(isStiff));
  const still = agents.every(
    (agent) => same(by(agent), { x: 0, y: 0 }) && same(sizeOf(old.get(agent)!), sizeOf(boxes.get(agent)!)),
  );
  const shifted = (points: readonly Point[], { x, y }: Point) => points.map((point) => ({ x: point.x + x, y: point.y + y }));

  /** The present place of an end of a line. */
  const endAt = (point: Point, paths: readonly string[], agent?: string): Rim | undefined => {
    const found = rimAt(point, old, paths) ?? (agent === undefined ? undefined : rimAt(point, old, [agent]));
    if (!found) return undefined;
    const { path, side } = found;
    const [before, after] = [old.get(path)!, boxes.get(path)!];
    const across = side === "right" ? after.width - before.width : 0;
    const down = side === "bottom" ? after.height - before.height : 0;
    const inwards = path === agent;
    return { x: point.x - before.x + after.x + across, y: point.y - before.y + after.y + down, side, inwards };
  };

  const labels = new Map(drawing.labels);
  const led: Point[][] = [];
  const wires = drawing.wires.map((wire) => {
    const agent = agents.find((one) => contains(old.get(one)!, wire.points[0]!) && contains(old.get(one)!, wire.points.at(-1)!));
    if (agent === undefined) return wire;
    const label = drawing.labels.get(wire.channel);
    if (stiff.has(agent)) {
      if (label && !wire.bundle) labels.set(wire.channel, { ...label, x: label.x + by(agent).x, y: label.y + by(agent).y });
      return { ...wire, points: shifted(wire.points, by(agent)) };
    }
    const own = parts.filter((path) => agentOf(path) === agent);
    const [from, to] = [endAt(wire.points[0]!, own, agent), endAt(wire.points.at(-1)!, own, agent)];
    if (!from || !to) return { ...wire, points: shifted(wire.points, by(agent)) };
    const obstacles = own.map((path) => boxes.get(path)!);
    const points = wayAround(from, to, obstacles, led);
    led.push(points);
    if (label && !wire.bundle)
      labels.set(wire.channel, labelOn(points, label, [...obstacles, ...takenBy(labels, drawing.labels)]));
    return { ...wire, points };
  });

  const trunks: Point[][] = [];
  const numbers: Box[] = [];
  const bundles = drawing.bundles.map((bundle) => {
    if (still) return bundle;
    const [from, to] = [endAt(bundle.points[0]!, agents), endAt(bundle.points.at(-1)!, agents)];
    if (!from || !to) return bundle;
    const obstacles = agents.map((path) => boxes.get(path)!);
    const points = wayAround(from, to, obstacles, trunks);
    trunks.push(points);
    const label = labelOn(points, bundle.label, [...obstacles, ...numbers]);
    numbers.push(label);
    return { ...bundle, points, label };
  });
  return {
    ...drawing,
    ...extent([...boxes.values(), ...bundles.map(({ points }) => boundsOf(points))]),
    boxes,
    wires,
    labels,
    bundles,
  };
}

/** Labels that have their new place already. */
const takenBy = (now: ReadonlyMap<number, Box>, before: ReadonlyMap<number, Box>) =>
  [...now].flatMap(([channel, box]) => (before.get(channel) === box ? [] : [box]));

const sizeOf = ({ width, height }: Box): Point => ({ x: width, y: height });

const contains = ({ x, y, width, height }: Box, point: Point) =>
  point.x >= x - 3 && point.x <= x + width + 3 && point.y >= y - 3 && point.y <= y + height + 3;

const boundsOf = (points: readonly Point[]): Box => {
  const [xs, ys] = [points.map(({ x }) => x), points.map(({ y }) => y)];
  const [x, y] = [Math.min(...xs), Math.min(...ys)];
  return { x, y, width: Math.max(...xs) - x, height: Math.max(...ys) - y };
};

/** The part of the plane that a drawing takes. */
function extent(boxes: readonly Box[]): { left: number; top: number; width: number; height: number } {
  const left = Math.min(0, ...boxes.map(({ x }) => x));
  const top = Math.min(0, ...boxes.map(({ y }) => y));
  const right = Math.max(...boxes.map(({ x, width }) => x + width)) + rim;
  const bottom = Math.max(...boxes.map(({ y, height }) => y + height)) + rim;
  return { left, top, width: right - left, height: bottom - top };
}

/** The position to keep for a box that was moved by units of the drawing; undefined: no such box can be moved. */
export function positionAfter({ boxes }: StructureDrawing, path: string, by: Point): readonly [number, number] | undefined {
  const box = boxes.get(path);
  const agent = boxes.get(agentOf(path));
  if (!box || !agent || path.includes("#")) return undefined;
  const from = isSubsystem(path) ? agent : { x: 0, y: 0 };
  const least = isSubsystem(path) ? { x: rim, y: agentHead + 6 } : { x: -Infinity, y: -Infinity };
  return [Math.round(Math.max(least.x, box.x - from.x + by.x)), Math.round(Math.max(least.y, box.y - from.y + by.y))];
}
