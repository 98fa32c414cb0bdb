import type { Box, Point } from "../net/geometry";
import type { ElkNode } from "../net/layout";
import { levelOf, markOf, type Arrow, type Level } from "./machine";
import type { Behaviour, Structure, Subsystem } from "./structure";
import { fontSize, lineHeight, wrapped, type Measure } from "./text_size";

/** The layout of state machines: ELK places the states from above to below, and leads the arrows around them. */

export interface DrawnArrow extends Arrow {
  points: Point[];
  /** The label in lines. */
  lines: string[];
  /** The place of the label; undefined: it has none. */
  place: Box | undefined;
}
export interface Machine {
  width: number;
  height: number;
  /** Behaviours, groups and marks, by path. Their corner is that of the machine. */
  states: Map<string, Box>;
  arrows: DrawnArrow[];
}

/** The text of the chip of a behaviour: "lend[i]" stands for one for each member of a fleet. */
export const chipText = (one: Behaviour) => (one.for ? `${one.name}[i]` : one.name);

export const chipHeight = 24;
/** Space on both sides of the name in a chip. */
const chipPadding = 20;
/** Conditions that are wider have several lines. */
const labelRoom = 170;
const labelLine = fontSize.text * lineHeight;
/** Space on both sides of a label, so that it does not touch its arrow. */
const labelPadding = 8;
const markSize = { start: 10, end: 14, failures: 10 };

const options = {
  "elk.algorithm": "layered",
  "elk.direction": "DOWN",
  "elk.edgeRouting": "ORTHOGONAL",
  "elk.spacing.nodeNode": "16",
  "elk.spacing.edgeNode": "10",
  "elk.spacing.edgeEdge": "9",
  "elk.spacing.edgeLabel": "2",
  "elk.layered.spacing.nodeNodeBetweenLayers": "14",
  "elk.layered.spacing.edgeNodeBetweenLayers": "9",
  "elk.layered.spacing.edgeEdgeBetweenLayers": "9",
  "elk.edgeLabels.placement": "CENTER",
  "elk.layered.edgeLabels.sideSelection": "ALWAYS_DOWN",
  "elk.layered.considerModelOrder.strategy": "PREFER_EDGES",
  // From above to below in the order of the file: what leads back is an arrow upwards.
  "elk.layered.cycleBreaking.strategy": "MODEL_ORDER",
  "elk.layered.nodePlacement.strategy": "NETWORK_SIMPLEX",
  // Behaviours that no entry leads to yet stand in rows.
  "elk.separateConnectedComponents": "true",
  "elk.spacing.componentComponent": "14",
  "elk.aspectRatio": "1.2",
  "org.eclipse.elk.json.edgeCoords": "ROOT",
  "org.eclipse.elk.json.shapeCoords": "ROOT",
};

const chipWidth = (behaviour: Behaviour, measure: Measure) => measure(chipText(behaviour), "text") * 1.03 + chipPadding;

export const labelLines = (label: string, measure: Measure) => (label === "" ? [] : wrapped(label, labelRoom, measure));

function levelGraph(level: Level, padding: string, inside: (group: Behaviour) => ElkNode, measure: Measure): ElkNode {
  const children = [
    ...level.marks.map((mark): ElkNode => {
      const layer = mark === "start" ? "FIRST" : mark === "end" ? "LAST" : "NONE";
      const layoutOptions = { "elk.layered.layering.layerConstraint": layer };
      return { id: `${level.path}#${mark}`, width: markSize[mark], height: markSize[mark], layoutOptions };
    }),
    ...level.states.map((state): ElkNode =>
      state.isGroup ? inside(state) : { id: state.path, width: chipWidth(state, measure), height: chipHeight },
    ),
  ];
  const edges = level.arrows.map(({ from, to, label }, at) => {
    const lines = labelLines(label, measure);
    const width = Math.max(0, ...lines.map((line) => measure(line, "text"))) * 1.03 + labelPadding;
    const size = { width, height: lines.length * labelLine };
    const labels = lines.length === 0 ? [] : [{ id: `${level.path}#label${at}`, text: "label", ...size }];
    return { id: `${level.path}#${at}`, sources: [from], targets: [to], labels };
  });
  return { id: level.path, children, edges, layoutOptions: { ...options, "elk.padding": padding } };
}

/** The graph of the machine of a subsystem, for ELK. */
export function machineGraph(structure: Structure, subsystem: Subsystem, measure: Measure): ElkNode {
  const inside = (group: Behaviour): ElkNode => {
    const graph = levelGraph(levelOf(structure, subsystem, group.path), "[top=34,left=10,bottom=10,right=10]", inside, measure);
    const least = `(${chipWidth(group, measure) + 8},40)`;
    const size = { "elk.nodeSize.constraints": "[MINIMUM_SIZE]", "elk.nodeSize.minimum": least };
    return { ...graph, layoutOptions: { ...graph.layoutOptions, ...size } };
  };
  return levelGraph(levelOf(structure, subsystem), "[top=4,left=2,bottom=2,right=2]", inside, measure);
}

/** Reads the layout of a graph of machineGraph. */
export function readMachine(structure: Structure, subsystem: Subsystem, laidOut: ElkNode, measure: Measure): Machine {
  const [left, top] = [laidOut.x ?? 0, laidOut.y ?? 0];
  const here = ({ x, y }: { x?: number; y?: number }): Point => ({ x: (x ?? 0) - left, y: (y ?? 0) - top });
  const sized = (one: { x?: number; y?: number; width?: number; height?: number }): Box => ({
    ...here(one),
    width: one.width ?? 0,
    height: one.height ?? 0,
  });
  const states = new Map<string, Box>();
  const arrows: DrawnArrow[] = [];
  const read = (node: ElkNode, group: string) => {
    const level = levelOf(structure, subsystem, group);
    for (const child of node.children ?? []) {
      states.set(child.id, sized(child));
      if (child.children && !markOf(child.id)) read(child, child.id);
    }
    (node.edges ?? []).forEach((edge, at) => {
      const arrow = level.arrows[at]!;
      const points = (edge.sections ?? []).flatMap(({ startPoint, bendPoints = [], endPoint }) =>
        [startPoint, ...bendPoints, endPoint].map(here),
      );
      const place = edge.labels?.[0] && sized(edge.labels[0]);
      arrows.push({ ...arrow, points, lines: labelLines(arrow.label, measure), place });
    });
  };
  read(laidOut, "");
  return { width: laidOut.width ?? 0, height: laidOut.height ?? 0, states, arrows };
}
