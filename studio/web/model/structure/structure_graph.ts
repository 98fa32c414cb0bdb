import type { Box, Point } from "../net/geometry";
import type { Elk, ElkEdge, ElkNode } from "../net/layout";
import { channelLabel, withoutIndex, type Channel, type Structure, type Subsystem } from "./structure";
import { placed, routed, type End, type Trunk } from "./structure_grid";
import { deviceHeight, gap, head, heightOf, row, width, withDevice } from "./structure_layout";

/**
 * The drawing of a structure. Agents stand in a grid, beside those that they share channels with
 * (structure_grid.ts). The channels between two agents share one line, the trunk, from rim to rim through the
 * lanes between the columns. Within an agent, ELK leads the channels around the subsystems. So no line passes
 * through a box.
 */

export interface Wire {
  /** Indices of the channels that it carries. */
  channels: number[];
  points: Point[];
  /** Whether it leads into an input: it ends in a tip. */
  ends: boolean;
  /** For a line from agent to agent: whether values go to its beginning, and to its end. */
  between?: { back: boolean; forth: boolean };
}
export interface StructureDrawing {
  width: number;
  height: number;
  /** Boxes of agents, subsystems and devices ("a.motor#device"), by path. */
  boxes: Map<string, Box>;
  wires: Wire[];
  /** Lines of channels, by their indices. */
  labels: Map<number, Box>;
}

/** Letters of labels and the spaces between them, at their largest. */
const letter = 11.1;
const space = 4.6;
const labelHeight = 20;
const labelPitch = 22;

/** The size of a channel's label. */
export const labelWidth = (channel: Channel) => {
  const { modes, timeout } = channelLabel(channel);
  const text = `${isNext(channel) ? "↻ " : ""}${modes}${timeout ? ` ${timeout}` : ""}`;
  const spaces = text.split(" ").length - 1;
  return (text.length - spaces) * letter + spaces * space + 10;
};

/** It leads from one member of a fleet to another: `robot[i].a.x -> robot[i+1].b.y`. */
export const isNext = ({ from, to }: Channel) =>
  from.includes("[") && indexOf(from) !== indexOf(to) && agentOf(from) === agentOf(to);

const indexOf = (path: string) => /\[([^\]]*)\]/.exec(path)?.[1] ?? "";
const agentOf = (path: string) => withoutIndex(path).split(".")[0]!;

const portAt = (subsystem: Subsystem, path: string): Point | undefined => {
  for (const direction of ["input", "output"] as const) {
    const at = subsystem.buffers.filter((one) => one.direction === direction).findIndex((one) => one.path === path);
    if (at >= 0) return { x: direction === "input" ? 0 : width[subsystem.kind], y: head + at * row + row / 2 };
  }
  return undefined;
};

/** The channels whose two ends both exist. */
export function connected(structure: Structure): Channel[] {
  const there = new Set(
    structure.agents.flatMap((agent) =>
      agent.subsystems.flatMap((one) => one.buffers.filter(({ direction }) => direction !== "real").map(({ path }) => path)),
    ),
  );
  return structure.channels.filter(({ from, to }) => there.has(withoutIndex(from)) && there.has(withoutIndex(to)));
}

const crosses = ({ from, to }: Channel) => agentOf(from) !== agentOf(to);

function trunksOf(channels: readonly Channel[]): Trunk[] {
  const trunks = new Map<string, Trunk>();
  for (const channel of channels.filter(crosses)) {
    const agents = [agentOf(channel.from), agentOf(channel.to)].sort() as [string, string];
    const id = agents.join("|");
    const known = trunks.get(id) ?? { id, agents, channels: [], label: { width: 0, height: 0 } };
    known.channels.push(channel.index);
    known.label = { width: Math.max(known.label.width, labelWidth(channel)), height: known.channels.length * labelPitch };
    trunks.set(id, known);
  }
  return [...trunks.values()];
}

const columnOf = { receptor: "0", control: "1", effector: "2" };

const onSide = (side: End["side"]) => ({ "org.eclipse.elk.port.side": side });

const options = {
  "elk.algorithm": "layered",
  "elk.direction": "RIGHT",
  "elk.edgeRouting": "ORTHOGONAL",
  "elk.spacing.nodeNode": "30",
  "elk.spacing.edgeNode": "16",
  "elk.spacing.edgeEdge": "12",
  "elk.spacing.edgeLabel": "4",
  "elk.spacing.labelLabel": "6",
  "elk.spacing.portPort": "6",
  "elk.spacing.componentComponent": "40",
  "elk.layered.spacing.nodeNodeBetweenLayers": "40",
  "elk.layered.spacing.edgeNodeBetweenLayers": "16",
  "elk.layered.spacing.edgeEdgeBetweenLayers": "12",
  "elk.edgeLabels.inline": "true",
  "elk.edgeLabels.placement": "CENTER",
  "elk.layered.nodePlacement.strategy": "NETWORK_SIMPLEX",
  "org.eclipse.elk.json.edgeCoords": "ROOT",
  "org.eclipse.elk.json.shapeCoords": "ROOT",
};

/** A drawing of an agent by itself; its upper left corner is the origin. */
interface Inside {
  box: Box;
  parts: Map<string, Box>;
  wires: Wire[];
  labels: Map<number, Box>;
  /** The points where trunks meet the rim. */
  ports: Map<string, Point>;
}

function insideGraph(
  name: string,
  structure: Structure,
  channels: readonly Channel[],
  trunks: readonly Trunk[],
  ends: readonly End[],
): ElkNode {
  const { subsystems } = structure.agents.find((one) => one.name === name)!;
  const owns = (path: string) => agentOf(path) === name;
  const edges: ElkEdge[] = channels.flatMap((one): ElkEdge[] => {
    const [source, target] = [`port ${withoutIndex(one.from)}`, `port ${withoutIndex(one.to)}`];
    if (owns(one.from) && owns(one.to)) {
      const label = { id: `l${one.index}`, width: labelWidth(one), height: labelHeight, text: "channel" };
      return [{ id: `c${one.index}`, sources: [source], targets: [target], labels: [label] }];
    }
    if (!owns(one.from) && !owns(one.to)) return [];
    const trunk = trunks.find(({ channels: carried }) => carried.includes(one.index))!.id;
    const rim = `${name} ${trunk}`;
    return owns(one.from)
      ? [{ id: `o${one.index}`, sources: [source], targets: [rim] }]
      : [{ id: `i${one.index}`, sources: [rim], targets: [target] }];
  });
  const used = new Set(edges.flatMap(({ sources, targets }) => [...sources, ...targets]));
  return {
    id: name,
    layoutOptions: {
      ...options,
      "elk.padding": "[top=52,left=26,bottom=26,right=26]",
      "elk.nodeSize.constraints": "[PORTS, MINIMUM_SIZE]",
      "elk.nodeSize.minimum": `(${Math.min(name.length, 30) * 9 + 110},90)`,
      "elk.portConstraints": "FIXED_ORDER",
      // Receptors on the left, effectors on the right, also those without a connection.
      "elk.partitioning.activate": "true",
      "elk.separateConnectedComponents": "false",
    },
    ports: ends.map(({ trunk, side, room }, at) => ({
      id: `${name} ${trunk}`,
      width: 1,
      height: room,
      // Clockwise: those on the left are counted from below.
      layoutOptions: { ...onSide(side), "elk.port.index": String(side === "EAST" ? at : 10_000 - at) },
    })),
    children: subsystems.map((one) => ({
      id: one.path,
      width: width[one.kind],
      height: withDevice(one),
      layoutOptions: { "elk.portConstraints": "FIXED_POS", "elk.partitioning.partition": columnOf[one.kind] },
      ports: one.buffers.flatMap(({ path }) => {
        const at = used.has(`port ${path}`) ? portAt(one, path) : undefined;
        return at
          ? [{ id: `port ${path}`, ...at, width: 0, height: 0, layoutOptions: onSide(at.x === 0 ? "WEST" : "EAST") }]
          : [];
      }),
    })),
    edges,
  };
}

const boxOf = (one: { x?: number; y?: number; width?: number; height?: number }): Box => ({
  x: one.x ?? 0,
  y: one.y ?? 0,
  width: one.width ?? 0,
  height: one.height ?? 0,
});

function readInside(agent: ElkNode): Inside {
  const { x, y, width: wide, height } = boxOf(agent);
  const away = <P extends Point>(point: P): P => ({ ...point, x: point.x - x, y: point.y - y });
  const wires: Wire[] = [];
  const labels = new Map<number, Box>();
  for (const edge of agent.edges ?? []) {
    const index = Number(edge.id.slice(1));
    for (const { startPoint, endPoint, bendPoints = [] } of edge.sections ?? [])
      wires.push({
        channels: [index],
        points: [startPoint, ...bendPoints, endPoint].map(away),
        ends: !edge.id.startsWith("o"),
      });
    for (const label of edge.labels ?? []) labels.set(index, away(boxOf(label)));
  }
  const ports = new Map<string, Point>();
  for (const port of agent.ports ?? []) {
    const at = away(boxOf(port));
    ports.set(port.id.slice(agent.id.length + 1), { x: at.x < wide / 2 ? 0 : wide, y: at.y + at.height / 2 });
  }
  // A wire ends at the rim and not at the rim of the port.
  const atRim = (point: Point) => ({ ...point, x: Math.min(Math.max(point.x, 0), wide) });
  for (const wire of wires) wire.points = wire.points.map(atRim);
  return {
    box: { x: 0, y: 0, width: wide, height },
    parts: new Map((agent.children ?? []).map((one) => [one.id, away(boxOf(one))])),
    wires,
    labels,
    ports,
  };
}

/** The device of a virtual receptor or effector is below it; for ELK both are one box. */
function addDevices(structure: Structure, boxes: Map<string, Box>): void {
  for (const one of structure.agents.flatMap(({ subsystems }) => subsystems)) {
    const box = boxes.get(one.path);
    if (!box || withDevice(one) === heightOf(one)) continue;
    box.height = heightOf(one);
    boxes.set(`${one.path}#device`, {
      x: box.x + 35,
      y: box.y + box.height + gap.device,
      width: box.width - 70,
      height: deviceHeight(one),
    });
  }
}

/** The approximate size of an agent. */
function sizeOf(subsystems: readonly Subsystem[]): { width: number; height: number } {
  const columns = (["receptor", "control", "effector"] as const).map((kind) => subsystems.filter((one) => one.kind === kind));
  const filled = columns.filter((column) => column.length > 0);
  const heights = filled.map((column) => column.reduce((sum, one) => sum + withDevice(one) + 30, 0));
  return { width: Math.max(filled.length * 340 + 60, 280), height: Math.max(60, ...heights) + 80 };
}

export async function drawStructure(structure: Structure, elk: Elk): Promise<StructureDrawing> {
  const channels = connected(structure);
  const trunks = trunksOf(channels);
  const grid = placed(
    structure.agents.map(({ name, subsystems }) => ({ name, ...sizeOf(subsystems) })),
    trunks,
  );
  const root = await elk({
    id: "insides",
    layoutOptions: options,
    children: structure.agents.map(({ name }) => insideGraph(name, structure, channels, trunks, grid.ends(name))),
  });
  const insides = new Map((root.children ?? []).map((agent) => [agent.id, readInside(agent)]));
  const outside = routed(grid, trunks, (agent) => insides.get(agent)!);
  const drawing: StructureDrawing = { ...outside.size, boxes: new Map(), wires: [], labels: new Map() };
  for (const { id, first, points, label } of outside.trunks) {
    const carried = trunks.find((one) => one.id === id)!.channels;
    const forth = (index: number) => agentOf(structure.channels[index]!.from) === first;
    const between = { back: !carried.every(forth), forth: carried.some(forth) };
    drawing.wires.push({ channels: carried, points, ends: false, between });
    carried.forEach((index, line) =>
      drawing.labels.set(index, { x: label.x, y: label.y + line * labelPitch, width: label.width, height: labelHeight }),
    );
  }
  for (const [name, at] of outside.agents) {
    const { parts, wires, labels } = insides.get(name)!;
    const here = <P extends Point>(point: P): P => ({ ...point, x: point.x + at.x, y: point.y + at.y });
    drawing.boxes.set(name, at);
    for (const [path, box] of parts) drawing.boxes.set(path, here(box));
    for (const [index, box] of labels) drawing.labels.set(index, here(box));
    drawing.wires.push(...wires.map((wire) => ({ ...wire, points: wire.points.map(here) })));
  }
  addDevices(structure, drawing.boxes);
  return drawing;
}
