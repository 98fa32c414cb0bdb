import { withoutIndex, type Agent, type Buffer, type Structure, type Subsystem } from "./structure";

/** A buffer that a channel could lead to or come from. */
export interface Partner {
  path: string;
  /** Why it does not fit; empty: it fits. */
  reason: string;
}

/** Why a buffer cannot be the other end of a channel. */
export const already = "connected already";

/** The name of a buffer in a channel: `robot[i].control.line` for each member of a fleet. */
export function channelEnd(structure: Structure, path: string): string {
  const agent = structure.agents.find((one) => path.startsWith(`${one.name}.`));
  return agent?.count ? path.replace(agent.name, `${agent.name}[i]`) : path;
}

/** The buffers at the other ends of all channels of a buffer. */
function connected(structure: Structure, { path, direction }: Buffer): string[] {
  const [own, other] = direction === "output" ? (["from", "to"] as const) : (["to", "from"] as const);
  return structure.channels.filter((one) => withoutIndex(one[own]) === path).map((one) => withoutIndex(one[other]));
}

const isFed = (structure: Structure, input: Buffer) => connected(structure, input).length > 0;

/**
 * All buffers of the other direction in other subsystems, those that fit first. An input has one source, the ends have
 * the same type, and units may differ only if one end has none.
 */
export function partnersOf(structure: Structure, buffer: Buffer): Partner[] {
  if (buffer.direction === "real") return [];
  const wanted = buffer.direction === "output" ? "input" : "output";
  const own = subsystemOf(buffer.path);
  const others = connected(structure, buffer);
  const reason = (one: Buffer) => {
    if (others.includes(one.path)) return already;
    if (!sameType(one.type, buffer.type)) return `its type is ${one.type || "not given"}`;
    const input = wanted === "input" ? one : buffer;
    return isFed(structure, input) ? `${wanted === "input" ? "it" : "this input"} has its source already` : "";
  };
  return everyBuffer(structure)
    .filter((one) => one.direction === wanted && subsystemOf(one.path) !== own)
    .map((one) => ({ path: one.path, reason: reason(one) }))
    .sort((one, other) => Number(one.reason !== "") - Number(other.reason !== ""));
}

const subsystemOf = (path: string) => path.split(".").slice(0, 2).join(".");
const everyBuffer = (structure: Structure) =>
  structure.agents.flatMap((agent: Agent) => agent.subsystems.flatMap((one: Subsystem) => one.buffers));

function sameType(one: string, other: string): boolean {
  const [left, right] = [one, other].map((text) => {
    const [, type = "", unit = ""] = /^\s*([^\s[\]]+\s*(?:\[[^\]]*\])?)\s*(.*)$/.exec(text) ?? [];
    return { type: type.replace(/\s/g, ""), unit: unit.trim() };
  });
  return left!.type === right!.type && (!left!.unit || !right!.unit || left!.unit === right!.unit);
}
