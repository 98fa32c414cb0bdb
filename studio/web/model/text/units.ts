import type { Structure } from "../structure/structure";

/**
 * The unit of a value, from the type of its buffer or field of memory: "m/s"; empty: none.
 * path: "robot.control.motion.linear", "robot.control.memory.free".
 */
export function unitOf(structure: Structure, path: string): string {
  const [agent, subsystem, ...rest] = path.replace(/\[\d+\]/g, "").split(".");
  const owner = structure.agents.find(({ name }) => name === agent)?.subsystems.find(({ name }) => name === subsystem);
  const buffer = owner?.buffers.find(({ name }) => name === rest[0]);
  const remembered = owner && !buffer && rest[0] === "memory" ? [...owner.yaml, "memory", rest[1] ?? ""] : null;
  let type = buffer?.type ?? "";
  if (remembered) type = structure.yaml.valueText([...remembered, "type"]) ?? structure.yaml.valueText(remembered) ?? "";
  for (const field of rest.slice(remembered ? 2 : 1))
    type = structure.yaml.valueText(["types", type.replace(/\[.*/, "").trim(), field]) ?? "";
  return /^[a-z]+\d*(?:\[\d+\])?\s+(.+)$/.exec(type.trim())?.[1] ?? "";
}
