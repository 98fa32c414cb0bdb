import { withoutIndex, type Agent, type Buffer, type Structure, type Subsystem } from "./structure";

/** A buffer that a channel could lead to or come from. */
export interface Partner {
  path: string;
  /** Why it does not fit; empty: it fits. */
  reason: string;
}

/** Why a buffer cannot be the other end of a channel. */
export const already = "connected already";

const agentOf = (structure: Structure, path: string) => structure.agents.find((one) => path.startsWith(`${one.name}.`));

/** The name of a buffer in a channel: `robot[i].control.line` for each member of a fleet. */
export function channelEnd(structure: Structure, path: string): string {
  const agent = agentOf(structure, path);
  return agent?.count ? path.replace(agent.name, `${agent.name}[i]`) : path;
}

/** The fleet at one end of a channel, if a single agent is at the other. */
export function fleetOf(structure: Structure, path: string, other: string): string | undefined {
  const fleet = agentOf(structure, path);
  return fleet?.count && !agentOf(structure, other)?.count ? fleet.name : undefined;
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
    if (!fits(structure, one, buffer)) return `its type is ${one.type || "not given"}`;
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

/** Whether a type is an array with an element for each member of a fleet. */
export const isForEach = (fleet: string, type: string) => new RegExp(`\\[\\s*each\\s+${fleet}\\s*\\]`).test(type);
const element = (fleet: string, type: string) => type.replace(new RegExp(`\\[\\s*each\\s+${fleet}\\s*\\]`), "");

/** An end at a single agent may have an element for each member of the fleet at the other. */
function fits(structure: Structure, one: Buffer, other: Buffer): boolean {
  const fleets = [fleetOf(structure, one.path, other.path), fleetOf(structure, other.path, one.path)];
  const [left, right] = [fleets[1], fleets[0]].map((fleet, index) => {
    const { type } = index === 0 ? one : other;
    return fleet ? element(fleet, type) : type;
  });
  return sameType(left!, right!);
}

function sameType(one: string, other: string): boolean {
  const [left, right] = [one, other].map((text) => {
    const [, type = "", unit = ""] = /^\s*([^\s[\]]+\s*(?:\[[^\]]*\])?)\s*(.*)$/.exec(text) ?? [];
    return { type: type.replace(/\s/g, ""), unit: unit.trim() };
  });
  return left!.type === right!.type && (!left!.unit || !right!.unit || left!.unit === right!.unit);
}
