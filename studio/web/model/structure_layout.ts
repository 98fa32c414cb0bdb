import type { Agent, Structure, Subsystem } from "./structure";

/** Where the structure view puts things: receptors left, control in the middle, effectors right, agents below each other. */

export interface SubsystemBox {
  path: string;
  x: number;
  y: number;
  width: number;
  height: number;
}
export interface AgentBox extends SubsystemBox {
  subsystems: SubsystemBox[];
  /** Real receptors and effectors: the devices behind virtual ones, below them. */
  devices: (SubsystemBox & { of: string })[];
}

export const row = 22;
export const head = 44;
const width = { receptor: 190, control: 230, effector: 190 };
const gap = { x: 110, y: 30, device: 26 };

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
    const box = layoutAgent(agent, y);
    y += box.height + 60;
    return box;
  });
}

function layoutAgent(agent: Agent, top: number): AgentBox {
  const columns = (["receptor", "control", "effector"] as const)
    .map((kind) => agent.subsystems.filter((one) => one.kind === kind))
    .filter((column) => column.length > 0);
  const columnHeight = (column: Subsystem[]) => column.reduce((sum, one) => sum + withDevice(one) + gap.y, -gap.y);
  const tallest = Math.max(60, ...columns.map(columnHeight));
  const box: AgentBox = { path: agent.name, x: 0, y: top, width: 0, height: tallest + 66, subsystems: [], devices: [] };
  let x = 24;
  for (const column of columns) {
    const wide = width[column[0]!.kind];
    let y = top + 44 + (tallest - columnHeight(column)) / 2;
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
    x += wide + gap.x;
  }
  box.width = Math.max(x - gap.x + 24, 280);
  return box;
}
