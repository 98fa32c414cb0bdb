import { bar, foldedPage, header, margin, place, textWidth, type Box, type Point, type Route, type Sheet } from "./geometry";
import { conditionText, operationText } from "./labels";
import type { NetModel, Page } from "./net";

/**
 * The layout of one page at a time. A page has the same size on its parent's sheet whatever is inside. So a
 * change inside a page moves no element outside, and equal pages are laid out only once.
 */

export interface ElkNode {
  id: string;
  width?: number;
  height?: number;
  x?: number;
  y?: number;
  ports?: { id: string; x?: number; y?: number; width: number; height: number; layoutOptions?: Record<string, string> }[];
  children?: ElkNode[];
  edges?: ElkEdge[];
  layoutOptions?: Record<string, string>;
}
export interface ElkEdge {
  id: string;
  sources: string[];
  targets: string[];
  labels?: { id: string; text: string; x?: number; y?: number; width: number; height: number }[];
  sections?: { startPoint: Point; endPoint: Point; bendPoints?: Point[] }[];
}
export type Elk = (graph: ElkNode) => Promise<ElkNode>;

/** The size of an open page on its parent's sheet, by its layer. */
export const openSize: Record<Page["layer"], { width: number; height: number }> = {
  system: { width: 800, height: 600 },
  agent: { width: 420, height: 290 }, // depends on its subsystems, see agentSize
  subsystem: { width: 400, height: 290 },
  behaviour: { width: 230, height: 330 },
  communication: { width: 190, height: 150 },
};

export type Folded = (page: number) => boolean;

const isFan = (page: Page) => page.layer === "system" || page.layer === "agent";

/** The size of each node's symbol. */
function symbolSize(net: NetModel, page: Page, node: number, folded: Folded): { width: number; height: number } {
  const child = page.nodes[node]!.page;
  if (child === null) return { width: place, height: place };
  if (folded(child)) return { width: foldedPage, height: foldedPage };
  return net.page(child).layer === "agent" ? agentSize(net, child, folded) : openSize[net.page(child).layer];
}

/** An agent has the shape of the row of its subsystems; changes within them do not affect it. */
function agentSize(net: NetModel, agent: number, folded: Folded): { width: number; height: number } {
  const inside = fan(net, net.page(agent), folded);
  const width = Math.min(620, Math.max(260, inside.width * 0.42));
  return { width, height: Math.round((width * inside.height) / inside.width) + header };
}

/** Pages with equal signatures have equal sheets. */
export function signature(net: NetModel, index: number, folded: Folded): string {
  const page = net.page(index);
  const nodes = page.nodes.map((node, at) => {
    const size = symbolSize(net, page, at, folded);
    return `${node.name}:${size.width}x${size.height}:${operationText(page, node.operation)}:${node.fusion === null ? "" : "f"}`;
  });
  const bars = page.transitions.map((t) => `${t.name}${conditionText(t)}:${t.inputs.join()}>${t.outputs.join()}`);
  return `${page.layer};${nodes.join("|")};${bars.join("|")}`;
}

/** Lays out one page. The layered pages use ELK; the fans of system and agent do not. */
export async function layoutPage(net: NetModel, index: number, folded: Folded, elk: Elk): Promise<Sheet> {
  const page = net.page(index);
  if (isFan(page)) return fan(net, page, folded);
  const direction = page.layer === "subsystem" ? "right" : "down";
  const graph = await elk(elkGraph(net, page, folded, direction));
  return sheetOf(net, page, folded, direction, graph);
}

// ------------------------------------------------------------------------------------------------ fans

interface Grid {
  columns: number;
  cell: { width: number; height: number };
}

function gridOf(sizes: { width: number; height: number }[], labels: number): Grid {
  const width = Math.max(...sizes.map((size) => size.width), 60);
  const height = Math.max(...sizes.map((size) => size.height), 40);
  // In one row, the name is beside the symbol; in a grid, below it.
  if (sizes.length <= 4) {
    const cell = { width: width + Math.max(48, 2 * labels - width + 24), height: height + 60 };
    return { columns: Math.max(1, sizes.length), cell };
  }
  const cell = { width: Math.max(width, 1.4 * labels) + 48, height: height + 60 };
  return { columns: Math.ceil(Math.sqrt((sizes.length * cell.height * 1.25) / cell.width)), cell };
}

/** System and agent: a wide bar forks into all pages, and a wide bar joins them. Many pages form a grid. */
function fan(net: NetModel, page: Page, folded: Folded): Sheet {
  const pages = page.nodes.flatMap((node, at) => (node.page === null ? [] : [at]));
  const sizes = pages.map((at) => symbolSize(net, page, at, folded));
  const longest = Math.max(0, ...pages.map((at) => textWidth(page.nodes[at]!.name, 12)));
  const { columns, cell } = gridOf(sizes, longest);
  const rows = Math.max(1, Math.ceil(pages.length / columns));
  const top = margin + place + 26;
  const width = Math.min(columns, Math.max(1, pages.length)) * cell.width + 2 * margin;
  const bottom = top + bar.thick + rows * cell.height + 30;
  const nodes: Box[] = page.nodes.map(() => ({ x: 0, y: 0, width: place, height: place }));
  nodes[page.input] = { x: width / 2 - place / 2, y: margin, width: place, height: place };
  nodes[page.output] = { x: width / 2 - place / 2, y: bottom + bar.thick + 26, width: place, height: place };
  pages.forEach((at, order) => {
    const size = sizes[order]!;
    const x = margin + (order % columns) * cell.width + (cell.width - size.width) / 2;
    const y = top + bar.thick + 40 + Math.floor(order / columns) * cell.height + (cell.height - 60 - size.height) / 2;
    nodes[at] = { x, y, ...size };
  });
  const transitions = page.transitions.map((_, at) => ({
    x: margin,
    y: at === 0 ? top : bottom,
    width: width - 2 * margin,
    height: bar.thick,
  }));
  const sheet: Sheet = {
    width,
    height: bottom + bar.thick + 26 + place + margin,
    nodes,
    transitions,
    routes: [],
    direction: "down",
    grid: rows > 1,
  };
  const lane = cell.width / 2 - 12;
  sheet.routes = page.transitions.flatMap((transition, at) => fanRoutes(sheet, transition, at, lane));
  return sheet;
}

/**
 * Straight lines down in one row. In a grid, a lane beside each column, at `lane` from its middle; arcs reach
 * folded pages at their sides.
 */
function fanRoutes(sheet: Sheet, transition: Page["transitions"][number], at: number, lane: number): Route[] {
  const rod = sheet.transitions[at]!;
  const route = (node: number, into: "node" | "transition"): Route => {
    const box = sheet.nodes[node]!;
    const above = box.y < rod.y;
    const middle = { x: box.x + box.width / 2, y: above ? box.y + box.height : box.y };
    const end = { x: middle.x, y: above ? rod.y : rod.y + rod.height };
    const points = [middle, end];
    if (sheet.grid && box.width !== place) {
      const side = above ? 1 : -1;
      const x = middle.x + side * lane;
      if (box.width === foldedPage) {
        const y = box.y + box.height / 2;
        points.splice(0, 2, { x: middle.x + (side * box.width) / 2, y }, { x, y }, { x, y: end.y });
      } else {
        const turn = middle.y + side * 10;
        points.splice(1, 1, { x: middle.x, y: turn }, { x, y: turn }, { x, y: end.y });
      }
    }
    return { transition: at, node, into, points: into === "node" ? points.reverse() : points };
  };
  return [
    ...transition.inputs.map((node) => route(node, "transition")),
    ...transition.outputs.map((node) => route(node, "node")),
  ];
}

// ------------------------------------------------------------------------------------------------ layered

interface Symbol {
  width: number;
  height: number;
  /** Size of the symbol together with its labels. */
  outer: { width: number; height: number };
  /** Position of the symbol within. */
  offset: Point;
}

function withLabels(size: { width: number; height: number }, labels: string[], direction: "down" | "right"): Symbol {
  const text = Math.max(0, ...labels.filter(Boolean).map((label) => textWidth(label)));
  const lines = labels.filter(Boolean).length * 13;
  if (direction === "down") {
    const width = size.width + (text > 0 ? text + 8 : 0);
    return {
      ...size,
      outer: { width, height: Math.max(size.height, lines) },
      offset: { x: 0, y: Math.max(0, (lines - size.height) / 2) },
    };
  }
  const width = Math.max(size.width, text);
  return { ...size, outer: { width, height: size.height + lines + 4 }, offset: { x: (width - size.width) / 2, y: 0 } };
}

function nodeSymbol(net: NetModel, page: Page, node: number, folded: Folded, direction: "down" | "right"): Symbol {
  const { name, page: child, operation } = page.nodes[node]!;
  const size = symbolSize(net, page, node, folded);
  if (child !== null && !folded(child)) return { ...size, outer: size, offset: { x: 0, y: 0 } };
  return withLabels(size, [name, operationText(page, operation)], direction);
}

function barSymbol(transition: Page["transitions"][number], direction: "down" | "right"): Symbol {
  const size = direction === "down" ? { width: bar.long, height: bar.thick } : { width: bar.thick, height: bar.long };
  return withLabels(size, [transition.name, conditionText(transition)], direction);
}

function elkNode(id: string, symbol: Symbol, direction: "down" | "right"): ElkNode {
  const { offset, width, height, outer } = symbol;
  const port = (name: string, side: string, x: number, y: number) => ({
    id: `${id}.${name}`,
    x,
    y,
    width: 0,
    height: 0,
    layoutOptions: { "elk.port.side": side },
  });
  const ports =
    direction === "down"
      ? [
          port("in", "NORTH", offset.x + width / 2, 0),
          port("out", "SOUTH", offset.x + width / 2, outer.height),
          port("memory", "WEST", 0, offset.y + height / 2),
        ]
      : [
          port("in", "WEST", 0, offset.y + height / 2),
          port("out", "EAST", outer.width, offset.y + height / 2),
          port("memory", "SOUTH", offset.x + width / 2, outer.height),
        ];
  return { id, ...outer, ports, layoutOptions: { "elk.portConstraints": "FIXED_POS" } };
}

function elkGraph(net: NetModel, page: Page, folded: Folded, direction: "down" | "right"): ElkNode {
  const children = [
    ...page.nodes.map((_, at) => elkNode(`n${at}`, nodeSymbol(net, page, at, folded, direction), direction)),
    ...page.transitions.map((t, at) => elkNode(`t${at}`, barSymbol(t, direction), direction)),
  ];
  children[page.input]!.layoutOptions!["elk.layered.layering.layerConstraint"] = "FIRST";
  children[page.output]!.layoutOptions!["elk.layered.layering.layerConstraint"] = "LAST";
  // The memory of a channel, and what a subsystem knows, is beside the flow: its arcs do not count as steps, whatever their direction.
  const memory = (node: number, at: number): ElkEdge => ({
    id: memoryEdge(node, at),
    sources: [`n${node}.out`],
    targets: [`t${at}.memory`],
  });
  const isMemory = (node: number) => page.nodes[node]!.fusion !== null;
  const edges = page.transitions.flatMap((t, at): ElkEdge[] => [
    ...t.inputs
      .filter((node) => !isMemory(node))
      .map((node) => ({ id: `n${node}>t${at}`, sources: [`n${node}.out`], targets: [`t${at}.in`] })),
    ...t.outputs
      .filter((node) => !isMemory(node))
      .map((node) => ({ id: `t${at}>n${node}`, sources: [`t${at}.out`], targets: [`n${node}.in`] })),
    ...[...new Set([...t.inputs, ...t.outputs])].filter(isMemory).map((node) => memory(node, at)),
  ]);
  return {
    id: "page",
    children,
    edges,
    layoutOptions: {
      "elk.algorithm": "layered",
      "elk.direction": direction === "down" ? "DOWN" : "RIGHT",
      "elk.edgeRouting": "ORTHOGONAL",
      "elk.layered.considerModelOrder.strategy": "NODES_AND_EDGES",
      "elk.layered.nodePlacement.strategy": "NETWORK_SIMPLEX",
      "elk.layered.spacing.nodeNodeBetweenLayers": "26",
      "elk.layered.spacing.edgeNodeBetweenLayers": "12",
      "elk.spacing.nodeNode": "22",
      "elk.spacing.edgeNode": "14",
      "elk.spacing.edgeEdge": "9",
      "elk.layered.feedbackEdges": "true",
      "elk.separateConnectedComponents": "false",
      "elk.padding": `[top=${margin},left=${margin},bottom=${margin},right=${margin}]`,
    },
  };
}

const memoryEdge = (node: number, transition: number) => `n${node}~t${transition}`;

function sheetOf(net: NetModel, page: Page, folded: Folded, direction: "down" | "right", graph: ElkNode): Sheet {
  const boxes = new Map(graph.children?.map((child) => [child.id, child]));
  const symbol = (id: string, of: Symbol): Box => {
    const outer = boxes.get(id);
    return { x: (outer?.x ?? 0) + of.offset.x, y: (outer?.y ?? 0) + of.offset.y, width: of.width, height: of.height };
  };
  const nodes = page.nodes.map((_, at) => symbol(`n${at}`, nodeSymbol(net, page, at, folded, direction)));
  const transitions = page.transitions.map((t, at) => symbol(`t${at}`, barSymbol(t, direction)));
  const edges = new Map(graph.edges?.map((edge) => [edge.id, edge]));
  const route = (id: string, transition: number, node: number, into: "node" | "transition"): Route => {
    const memory = edges.get(memoryEdge(node, transition))?.sections?.[0];
    const section = memory ?? edges.get(id)?.sections?.[0];
    const points = section ? [section.startPoint, ...(section.bendPoints ?? []), section.endPoint] : [];
    const [begin, end] = into === "node" ? [transitions[transition]!, nodes[node]!] : [nodes[node]!, transitions[transition]!];
    if (memory) {
      const line = beside(points, nodes[node]!, transitions[transition]!, direction);
      return {
        transition,
        node,
        into,
        points: into === "node" ? line.reverse() : line,
      };
    }
    return { transition, node, into, points: meet(points, begin, end, direction) };
  };
  const routes = page.transitions.flatMap((t, at) => [
    ...t.inputs.map((node) => route(`n${node}>t${at}`, at, node, "transition")),
    ...t.outputs.map((node) => route(`t${at}>n${node}`, at, node, "node")),
  ]);
  return { width: graph.width ?? 0, height: graph.height ?? 0, nodes, transitions, routes, direction };
}

/** Ports are at the border of symbol and labels together; this continues the arc to the symbol itself. */
function meet(points: Point[], from: Box, to: Box, direction: "down" | "right"): Point[] {
  if (points.length < 2) return points;
  const ends = points.map((point) => ({ ...point }));
  const first = ends[0]!;
  const last = ends[ends.length - 1]!;
  if (direction === "down") {
    first.y = from.y + from.height;
    last.y = to.y;
  } else {
    first.x = from.x + from.width;
    last.x = to.x;
  }
  return ends;
}

/** Arcs of a memory begin at the place's border and end at the bar, also across the space of its label. */
const beside = (points: Point[], from: Box, to: Box, direction: "down" | "right"): Point[] => {
  const border = direction === "down" ? { y: from.y + from.height } : { x: from.x + from.width };
  const within = (y: number) => (direction === "down" ? y : Math.min(Math.max(y, to.y), to.y + to.height));
  return points.map((point, at) =>
    at === 0 ? { ...point, ...border } : { ...point, y: at === points.length - 1 ? within(point.y) : point.y },
  );
};

/** Position and scale of the inside of an open page within the page's box. */
export function inset(box: Box, sheet: Sheet): { x: number; y: number; scale: number } {
  const scale = Math.min((box.width - 8) / sheet.width, (box.height - header - 6) / sheet.height);
  return {
    x: box.x + (box.width - sheet.width * scale) / 2,
    y: box.y + header + (box.height - header - 4 - sheet.height * scale) / 2,
    scale,
  };
}
