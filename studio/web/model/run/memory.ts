import { withoutIndex } from "../structure/structure";

/** A value that a subsystem remembers. */
export interface Remembered {
  /** The name of the value in a run: "robot[3].control.memory.at.x". */
  path: string;
  /** "at.x"; in a fleet with the member: "robot[3]: at.x". */
  label: string;
}

/**
 * The memory of a subsystem among the values of a run. In the structure, a fleet is drawn once, as
 * `robot.control`: then it is the memory of all members, one after the other.
 */
export function memoryOf(paths: readonly string[], subsystem: string): Remembered[] {
  const found: Remembered[] = [];
  for (const path of paths) {
    const [agent, name, kind, ...field] = path.split(".");
    if (kind !== "memory" || field.length === 0) continue;
    const owner = `${agent}.${name}`;
    if (owner === subsystem) found.push({ path, label: field.join(".") });
    else if (withoutIndex(owner) === subsystem) found.push({ path, label: `${agent}: ${field.join(".")}` });
  }
  return found.sort((one, other) => one.path.localeCompare(other.path, "en", { numeric: true }));
}
