import { channelLabel, withoutIndex, type Agent, type Structure, type Subsystem } from "./structure";

/**
 * Layout of the structure view: receptors left, control in the middle, effectors
 * right, agents below each other.
 */

export interface SubsystemBox {
  path: string;
  x: number;
  y: number;
  width: number;
  height: number;
}
export interface AgentBox extends SubsystemBox {
  subsystems: SubsystemBox[];
  /** Real receptors and effectors: the devices of the virtual ones, drawn below them. */
  devices: (SubsystemBox & { of: string })[];
}

export const row = 22;
export const head = 44;
const width = { receptor: 190, control: 230, effector: 190 };
const gap = { x: 110, y: 30, device: 26 };
/** The gap between columns: a channel shows its label there, with a piece of line at each end. */
const gapFor = (labels: readonly { modes: string; timeout: string }[]) =>
  Math.max(gap.x, ...labels.map(({ modes, timeout }) => (modes.length + timeout.length) * 6.8 + 60));

export const ports = (subsystem: Subsystem) => {
  const count = (direction: "input" | "output") => subsystem.buffers.filter((buffer) => buffer.direction === direction).length;
  return Math.max(count("input"), count("output"), 1);
};

/** Lines of the chips that name the behaviours. */
export function chipLines(subsystem: Subsystem): number {
  const room = width[subsystem.kind] - 20;
  let [lines, used] = [1, 0];
  for (const { name } of subsystem.behaviours) {
    const chip = name.length * 6.6 + 24;
    if (used > 0 && used + chip > room) [lines, used] = [lines + 1, 0];
    used += chip;
  }
  return lines;
}

const heightOf = (subsystem: Subsystem) => head + ports(subsystem) * row + 14 + chipLines(subsystem) * 26 + 8;

const realOf = (subsystem: Subsystem) => subsystem.buffers.filter((buffer) => buffer.direction === "real").length;
const deviceHeight = (subsystem: Subsystem) => (realOf(subsystem) ? 26 + realOf(subsystem) * 18 : 0);
const withDevice = (subsystem: Subsystem) => heightOf(subsystem) + (realOf(subsystem) ? gap.device + deviceHeight(subsystem) : 0);

export function layoutStructure(structure: Structure): AgentBox[] {
  let y = 0;
  return structure.agents.map((agent) => {
    const own = structure.channels.filter((one) =>
      [one.from, one.to].every((end) => withoutIndex(end).startsWith(`${agent.name}.`)),
    );
    const box = layoutAgent(agent, y, gapFor(own.map(channelLabel)));
    const lanes = structure.channels.filter((one) => isBack(agent, one)).length;
    if (lanes > 0) box.height += 4 + lanes * lane;
    y += box.height + 60;
    return box;
  });
}

/** Channels that lead back to the left go below the boxes, each in its own lane. */
const lane = 22;
const columnOf = { receptor: 0, control: 1, effector: 2 };
const owner = (path: string) => withoutIndex(path).split(".").slice(0, 2).join(".");

function isBack(agent: Agent, channel: { from: string; to: string }): boolean {
  const [from, to] = [channel.from, channel.to].map((end) => agent.subsystems.find((one) => one.path === owner(end)));
  return from !== undefined && to !== undefined && columnOf[from.kind] >= columnOf[to.kind];
}

/** The heights of the channels that cannot lead straight to the right, by the channel's index. */
export function lanes(structure: Structure, boxes: readonly AgentBox[]): Map<number, number> {
  const heights = new Map<number, number>();
  const taken = new Map<string, number>();
  const next = (key: string) => (taken.set(key, (taken.get(key) ?? -1) + 1), taken.get(key)!);
  const agentOf = (path: string) => structure.agents.findIndex((agent) => path.startsWith(`${agent.name}.`));
  for (const channel of structure.channels) {
    const [from, to] = [agentOf(withoutIndex(channel.from)), agentOf(withoutIndex(channel.to))];
    if (from < 0 || to < 0) continue;
    const [upper, lower] = [boxes[Math.min(from, to)]!, boxes[Math.max(from, to)]!];
    if (from !== to) heights.set(channel.index, lower.y - 14 - (next(`${lower.path}^`) % 3) * 16);
    else if (isBack(structure.agents[from]!, channel))
      heights.set(channel.index, upper.y + upper.height - 18 - next(upper.path) * lane);
  }
  return heights;
}

function layoutAgent(agent: Agent, top: number, between: number): AgentBox {
  const columns = (["receptor", "control", "effector"] as const)
    .map((kind) => agent.subsystems.filter((one) => one.kind === kind))
    .filter((column) => column.length > 0);
  const columnHeight = (column: Subsystem[]) => column.reduce((sum, one) => sum + withDevice(one) + gap.y, -gap.y);
  const tallest = Math.max(60, ...columns.map(columnHeight));
  const box: AgentBox = { path: agent.name, x: 0, y: top, width: 0, height: tallest + 66, subsystems: [], devices: [] };
  // With one box per column, their tops are aligned, and so are the first channels.
  const inOneRow = columns.every((column) => column.length === 1);
  let x = 24;
  for (const column of columns) {
    const wide = width[column[0]!.kind];
    let y = top + 44 + (inOneRow ? 0 : (tallest - columnHeight(column)) / 2);
    for (const one of column) {
      const height = heightOf(one);
      box.subsystems.push({ path: one.path, x, y, width: wide, height });
      if (realOf(one))
        box.devices.push({
          path: `${one.path}#device`,
          of: one.path,
          x: x + 35,
          y: y + height + gap.device,
          width: wide - 70,
          height: deviceHeight(one),
        });
      y += withDevice(one) + gap.y;
    }
    x += wide + between;
  }
  box.width = Math.max(x - between + 24, 280);
  return box;
}
