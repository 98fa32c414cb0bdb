import type { Behaviour, Subsystem } from "./structure";

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

/** The width of the chip that names a behaviour. A name that is too long for a line is cut. */
export const chipWidth = ({ name }: Behaviour, { kind }: Subsystem) => Math.min(width[kind] - 20, name.length * 9 + 20);

/** Lines of the chips of a subsystem. */
export function chipLines(subsystem: Subsystem): number {
  const room = width[subsystem.kind] - 20;
  let [lines, used] = [1, 0];
  for (const behaviour of subsystem.behaviours) {
    const chip = chipWidth(behaviour, subsystem);
    if (used > 0 && used + chip > room) [lines, used] = [lines + 1, 0];
    used += chip + 4;
  }
  return lines;
}

export const heightOf = (subsystem: Subsystem) => head + ports(subsystem) * row + 14 + chipLines(subsystem) * 26 + 8;

const realOf = (subsystem: Subsystem) => subsystem.buffers.filter((buffer) => buffer.direction === "real").length;
export const deviceHeight = (subsystem: Subsystem) => (realOf(subsystem) ? 28 + realOf(subsystem) * 20 : 0);
export const withDevice = (subsystem: Subsystem) =>
  heightOf(subsystem) + (realOf(subsystem) ? gap.device + deviceHeight(subsystem) : 0);
