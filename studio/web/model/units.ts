import type { Structure } from "./structure";

/** The unit of a value, as the type of its buffer has it: "m/s"; empty: none. path: "robot.control.motion.linear". */
export function unitOf(structure: Structure, path: string): string {
  const [agent, subsystem, buffer, ...fields] = path.replace(/\[\d+\]/g, "").split(".");
  const owner = structure.agents.find(({ name }) => name === agent)?.subsystems.find(({ name }) => name === subsystem);
  let type = owner?.buffers.find(({ name }) => name === buffer)?.type ?? "";
  for (const field of fields) type = structure.yaml.valueText(["types", type.replace(/\[.*/, "").trim(), field]) ?? "";
  return /^[a-z]+\d*(?:\[\d+\])?\s+(.+)$/.exec(type.trim())?.[1] ?? "";
}
