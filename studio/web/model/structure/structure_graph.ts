import type { Box, Point } from "../net/geometry";
import type { Elk } from "../net/layout";
import { insideGraph, insideOptions, readInside, type Wire } from "./agent_inside";
import { agentOf, bundlesOf, connected, type Bundle } from "./bundles";
import { cardOf, gap, withDevice, type Card } from "./cards";
import { machineGraph, readMachine } from "./machine_layout";
import type { Agent, Structure } from "./structure";
import { placed, routed, type Trunk } from "./structure_grid";
import type { Measure } from "./text_size";

/**
 * The drawing of a structure. Boxes have the size of their names and of the state machines in them, which ELK lays out
 * first. Agents stand in a grid, beside those that they share channels with (structure_grid.ts). The channels between
 * two agents are one line, the bundle, from rim to rim through the lanes between the columns. Within an agent, ELK leads
 * the channels around the subsystems. So no line passes through a box.
 */

export interface DrawnBundle extends Bundle {
  points: Point[];
  /** The place of its number. */
  label: Box;
  /** Whether values go to its beginning, and to its end. */
  back: boolean;
  forth: boolean;
}
export interface StructureDrawing {
  /** The upper left corner, if boxes were moved beyond the origin. */
  left?: number;
  top?: number;
  width: number;
  height: number;
  /** Boxes of agents, subsystems and devices ("a.motor#device"), by path. */
  boxes: Map<string, Box>;
  /** What is in the boxes of subsystems, by path. */
  cards: Map<string, Card>;
  /** Lines within agents. */
  wires: Wire[];
  /** Labels of channels within agents, by their indices. */
  labels: Map<number, Box>;
  bundles: DrawnBundle[];
}

/** The number of a bundle: its letters grow up to this size while the drawing becomes smaller. */
export const mostBundleLetters = 32;
const bundleLabelHeight = 41;

const trunkOf = ({ path, agents, channels }: Bundle): Trunk => {
  const digits = String(channels.length).length;
  return { id: path, agents, channels, label: { width: 22 + digits * mostBundleLetters * 0.68, height: bundleLabelHeight } };
};

/** The device of a virtual receptor or effector is below it; for ELK both are one box. */
function addDevices(cards: ReadonlyMap<string, Card>, boxes: Map<string, Box>): void {
  for (const [path, { width, height, device }] of cards) {
    const box = boxes.get(path);
    if (!box || !device) continue;
    box.height = height;
    const x = box.x + (width - device.width) / 2;
    boxes.set(`${path}#device`, { x, y: box.y + height + gap.device, ...device });
  }
}

/** The approximate size of an agent. */
function sizeOf({ subsystems }: Agent, cards: ReadonlyMap<string, Card>): { width: number; height: number } {
  const columns = (["receptor", "control", "effector"] as const)
    .map((kind) => subsystems.filter((one) => one.kind === kind).map(({ path }) => cards.get(path)!))
    .filter((column) => column.length > 0);
  const width = columns.reduce((sum, column) => sum + Math.max(...column.map((card) => card.width)) + 90, 0);
  const heights = columns.map((column) => column.reduce((sum, card) => sum + withDevice(card) + 26, 0));
  return { width: Math.max(width, 200), height: Math.max(60, ...heights) + 70 };
}

async function cardsOf(structure: Structure, elk: Elk, measure: Measure): Promise<Map<string, Card>> {
  const subsystems = structure.agents.flatMap((agent) => agent.subsystems);
  const root = await elk({
    id: "machines",
    layoutOptions: insideOptions,
    children: subsystems.map((one) => machineGraph(structure, one, measure)),
  });
  const laidOut = new Map((root.children ?? []).map((one) => [one.id, one]));
  return new Map(
    subsystems.map((one) => {
      const machine = readMachine(structure, one, laidOut.get(one.path)!, measure);
      return [one.path, cardOf(structure, one, machine, measure)];
    }),
  );
}

export async function drawStructure(structure: Structure, elk: Elk, measure: Measure): Promise<StructureDrawing> {
  const channels = connected(structure);
  const bundles = bundlesOf(channels);
  const cards = await cardsOf(structure, elk, measure);
  const trunks = bundles.map(trunkOf);
  const grid = placed(
    structure.agents.map((agent) => ({ name: agent.name, ...sizeOf(agent, cards) })),
    trunks,
  );
  const root = await elk({
    id: "insides",
    layoutOptions: insideOptions,
    children: structure.agents.map(({ name }) => insideGraph(structure, name, channels, cards, grid.ends(name), measure)),
  });
  const insides = new Map((root.children ?? []).map((agent) => [agent.id, readInside(structure, agent)]));
  const outside = routed(grid, trunks, (agent) => insides.get(agent)!);
  const drawing: StructureDrawing = { ...outside.size, boxes: new Map(), cards, wires: [], labels: new Map(), bundles: [] };
  for (const bundle of bundles) {
    const { first, points, label } = outside.trunks.find(({ id }) => id === bundle.path)!;
    const forth = (index: number) => agentOf(structure.channels[index]!.from) === first;
    const { channels: carried } = bundle;
    drawing.bundles.push({ ...bundle, points, label, back: !carried.every(forth), forth: carried.some(forth) });
  }
  for (const [name, at] of outside.agents) {
    const { parts, wires, labels } = insides.get(name)!;
    const here = <P extends Point>(point: P): P => ({ ...point, x: point.x + at.x, y: point.y + at.y });
    drawing.boxes.set(name, at);
    for (const [path, box] of parts) drawing.boxes.set(path, here(box));
    for (const [index, box] of labels) drawing.labels.set(index, here(box));
    drawing.wires.push(...wires.map((wire) => ({ ...wire, points: wire.points.map(here) })));
  }
  addDevices(cards, drawing.boxes);
  return drawing;
}
