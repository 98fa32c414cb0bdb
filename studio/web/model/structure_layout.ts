import type { Subsystem } from "./structure";

/** Sizes of the boxes of the structure view. */

export const row = 22;
export const head = 44;
export const width = { receptor: 200, control: 240, effector: 200 };
export const gap = { device: 26 };

export const ports = (subsystem: Subsystem) => {
  const count = (direction: "input" | "output") => subsystem.buffers.filter((buffer) => buffer.direction === direction).length;
  return Math.max(count("input"), count("output"), 1);
};

/** Lines of the chips that name the behaviours. A name that is too long for a line is cut. */
export function chipLines(subsystem: Subsystem): number {
  const room = width[subsystem.kind] - 20;
  let [lines, used] = [1, 0];
  for (const { name } of subsystem.behaviours) {
    const chip = Math.min(room, name.length * 7 + 26);
    if (used > 0 && used + chip > room) [lines, used] = [lines + 1, 0];
    used += chip + 4;
  }
  return lines;
}

export const heightOf = (subsystem: Subsystem) => head + ports(subsystem) * row + 14 + chipLines(subsystem) * 26 + 8;

const realOf = (subsystem: Subsystem) => subsystem.buffers.filter((buffer) => buffer.direction === "real").length;
export const deviceHeight = (subsystem: Subsystem) => (realOf(subsystem) ? 26 + realOf(subsystem) * 18 : 0);
export const withDevice = (subsystem: Subsystem) =>
  heightOf(subsystem) + (realOf(subsystem) ? gap.device + deviceHeight(subsystem) : 0);
