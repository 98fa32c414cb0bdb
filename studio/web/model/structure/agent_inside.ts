import type { Box, Point } from "../net/geometry";
import type { ElkEdge, ElkNode } from "../net/layout";
import { agentOf, bundlePath, isNext } from "./bundles";
import { agentNameWidth, head, row, withDevice, type Card } from "./cards";
import { channelLabel, withoutIndex, type Channel, type Structure, type Subsystem } from "./structure";
import type { End } from "./structure_grid";
import type { Measure } from "./text_size";

/** The layout within an agent: receptors on the left, effectors on the right, and the channels between them. */

export interface Wire {
  /** The index of the channel that it carries. */
  channel: number;
  points: Point[];
  /** Whether it leads into an input: it ends in a tip. */
  ends: boolean;
  /** The bundle that continues it outside of the agent; undefined: it stays within the agent. */
  bundle: string | undefined;
}

const labelHeight = 20;
/** Space on both sides of the text of a label. */
const labelPadding = 12;

/** The text of the label of a channel within an agent. */
export function labelText(channel: Channel): string {
  const { modes, timeout } = channelLabel(channel);
  return `${isNext(channel) ? "↻ " : ""}${modes}${timeout ? ` ${timeout}` : ""}`;
}

const portAt = (subsystem: Subsystem, card: Card, path: string): Point | undefined => {
  for (const direction of ["input", "output"] as const) {
    const at = subsystem.buffers.filter((one) => one.direction === direction).findIndex((one) => one.path === path);
    if (at >= 0) return { x: direction === "input" ? 0 : card.width, y: head + at * row + row / 2 };
  }
  return undefined;
};

const columnOf = { receptor: "0", control: "1", effector: "2" };

const onSide = (side: End["side"]) => ({ "org.eclipse.elk.port.side": side });

export const insideOptions = {
  "elk.algorithm": "layered",
  "elk.direction": "RIGHT",
  "elk.edgeRouting": "ORTHOGONAL",
  "elk.spacing.nodeNode": "26",
  "elk.spacing.edgeNode": "12",
  "elk.spacing.edgeEdge": "9",
  "elk.spacing.edgeLabel": "4",
  "elk.spacing.labelLabel": "6",
  "elk.spacing.portPort": "6",
  "elk.spacing.componentComponent": "40",
  "elk.layered.spacing.nodeNodeBetweenLayers": "30",
  "elk.layered.spacing.edgeNodeBetweenLayers": "13",
  "elk.layered.spacing.edgeEdgeBetweenLayers": "9",
  "elk.edgeLabels.inline": "true",
  "elk.edgeLabels.placement": "CENTER",
  "elk.layered.nodePlacement.strategy": "NETWORK_SIMPLEX",
  "org.eclipse.elk.json.edgeCoords": "ROOT",
  "org.eclipse.elk.json.shapeCoords": "ROOT",
};

/** A drawing of an agent by itself; its upper left corner is the origin. */
export interface Inside {
  box: Box;
  parts: Map<string, Box>;
  wires: Wire[];
  labels: Map<number, Box>;
  /** The points where trunks meet the rim. */
  ports: Map<string, Point>;
}

/** The graph of what is in an agent, for ELK. ends: where bundles meet its rim. */
export function insideGraph(
  structure: Structure,
  name: string,
  channels: readonly Channel[],
  cards: ReadonlyMap<string, Card>,
  ends: readonly End[],
  measure: Measure,
): ElkNode {
  const agent = structure.agents.find((one) => one.name === name)!;
  const owns = (path: string) => agentOf(path) === name;
  const edges: ElkEdge[] = channels.flatMap((one): ElkEdge[] => {
    const [source, target] = [`port ${withoutIndex(one.from)}`, `port ${withoutIndex(one.to)}`];
    if (owns(one.from) && owns(one.to)) {
      const label = {
        id: `l${one.index}`,
        width: measure(labelText(one), "text") * 1.03 + labelPadding,
        height: labelHeight,
        text: "channel",
      };
      return [{ id: `c${one.index}`, sources: [source], targets: [target], labels: [label] }];
    }
    if (!owns(one.from) && !owns(one.to)) return [];
    const rim = `${name} ${bundlePath(one)!}`;
    return owns(one.from)
      ? [{ id: `o${one.index}`, sources: [source], targets: [rim] }]
      : [{ id: `i${one.index}`, sources: [rim], targets: [target] }];
  });
  const used = new Set(edges.flatMap(({ sources, targets }) => [...sources, ...targets]));
  return {
    id: name,
    layoutOptions: {
      ...insideOptions,
      "elk.padding": "[top=50,left=20,bottom=20,right=20]",
      "elk.nodeSize.constraints": "[PORTS, MINIMUM_SIZE]",
      "elk.nodeSize.minimum": `(${agentNameWidth(agent, measure)},90)`,
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
    children: agent.subsystems.map((one) => {
      const card = cards.get(one.path)!;
      return {
        id: one.path,
        width: card.width,
        height: withDevice(card),
        layoutOptions: { "elk.portConstraints": "FIXED_POS", "elk.partitioning.partition": columnOf[one.kind] },
        ports: one.buffers.flatMap(({ path }) => {
          const at = used.has(`port ${path}`) ? portAt(one, card, path) : undefined;
          const side = at?.x === 0 ? "WEST" : "EAST";
          return at ? [{ id: `port ${path}`, ...at, width: 0, height: 0, layoutOptions: onSide(side) }] : [];
        }),
      };
    }),
    edges,
  };
}

const boxOf = (one: { x?: number; y?: number; width?: number; height?: number }): Box => ({
  x: one.x ?? 0,
  y: one.y ?? 0,
  width: one.width ?? 0,
  height: one.height ?? 0,
});

/** Reads the layout of a graph of insideGraph. */
export function readInside(structure: Structure, agent: ElkNode): Inside {
  const { x, y, width: wide, height } = boxOf(agent);
  const away = <P extends Point>(point: P): P => ({ ...point, x: point.x - x, y: point.y - y });
  const wires: Wire[] = [];
  const labels = new Map<number, Box>();
  for (const edge of agent.edges ?? []) {
    const index = Number(edge.id.slice(1));
    for (const { startPoint, endPoint, bendPoints = [] } of edge.sections ?? [])
      wires.push({
        channel: index,
        points: [startPoint, ...bendPoints, endPoint].map(away),
        ends: !edge.id.startsWith("o"),
        bundle: edge.id.startsWith("c") ? undefined : bundlePath(structure.channels[index]!),
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
