import { behavioursIn, type Behaviour, type Subsystem } from "./structure";

/**
 * Sizes of the boxes of the structure view. Far away, letters are drawn larger, up to 18.4 units, which have
 * ten pixels when the drawing has a little more than half its size (canvas/detail.ts).
 */

export const row = 22;
export const head = 50;
export const width = { receptor: 200, control: 240, effector: 200 };
export const gap = { device: 26 };

export const ports = (subsystem: Subsystem) => {
  const count = (direction: "input" | "output") => subsystem.buffers.filter((buffer) => buffer.direction === direction).length;
  return Math.max(count("input"), count("output"), 1);
};

/** The text of the chip of a behaviour: "lend[i]" stands for one for each member of a fleet. */
export const chipText = (one: Behaviour) => (one.for ? `${one.name}[i]` : one.name);

/** The space left of what is in a group. */
const indent = 10;
const depthOf = (group: string, subsystem: Subsystem) =>
  group === "" ? 0 : group.slice(subsystem.path.length + 1).split(".").length;
const roomIn = (group: string, subsystem: Subsystem) => width[subsystem.kind] - 20 - indent * depthOf(group, subsystem);

/** The width of the chip that names a behaviour. A name that is too long for a line is cut. */
export const chipWidth = (behaviour: Behaviour, subsystem: Subsystem) =>
  Math.min(roomIn(behaviour.isGroup ? behaviour.path : behaviour.group, subsystem), chipText(behaviour).length * 9 + 20);

/** Lines of the chips of a subsystem. */
export const chipLines = (subsystem: Subsystem): number => linesIn("", 0, subsystem);

/** used: the space that a chip before them takes. */
function linesIn(group: string, used: number, subsystem: Subsystem): number {
  const room = roomIn(group, subsystem);
  let lines = 1;
  for (const behaviour of behavioursIn(subsystem, group)) {
    const chip = chipWidth(behaviour, subsystem);
    if (used > 0 && (behaviour.isGroup || used + chip > room)) [lines, used] = [lines + 1, 0];
    if (behaviour.isGroup) lines += linesIn(behaviour.path, chip + 4, subsystem) - 1;
    // The behaviour after a group stands on the next line.
    used = behaviour.isGroup ? room : used + chip + 4;
  }
  return lines;
}

export const heightOf = (subsystem: Subsystem) => head + ports(subsystem) * row + 14 + chipLines(subsystem) * 26 + 8;

const realOf = (subsystem: Subsystem) => subsystem.buffers.filter((buffer) => buffer.direction === "real").length;
export const deviceHeight = (subsystem: Subsystem) => (realOf(subsystem) ? 28 + realOf(subsystem) * 20 : 0);
export const withDevice = (subsystem: Subsystem) =>
  heightOf(subsystem) + (realOf(subsystem) ? gap.device + deviceHeight(subsystem) : 0);
