import { withoutIndex, type Channel, type Structure } from "./structure";

/** Channels between two agents: they are drawn as one line, with their number. */
export interface Bundle {
  /** The text that selects it: "bundle:carrier|dock". */
  path: string;
  agents: readonly [string, string];
  /** Indices of its channels. */
  channels: number[];
}

export const agentOf = (path: string) => withoutIndex(path).split(".")[0]!;

/** Whether a channel leads from one agent to another; within a fleet, it does not. */
export const crosses = ({ from, to }: Channel) => agentOf(from) !== agentOf(to);

/** It leads from one member of a fleet to another: `robot[i].a.x -> robot[i+1].b.y`. */
export const isNext = ({ from, to }: Channel) =>
  from.includes("[") && indexOf(from) !== indexOf(to) && !crosses({ from, to } as Channel);

const indexOf = (path: string) => /\[([^\]]*)\]/.exec(path)?.[1] ?? "";

const prefix = "bundle:";
export const isBundlePath = (path: string) => path.startsWith(prefix);

/** The path of the bundle that a channel belongs to; undefined: it stays within an agent. */
export function bundlePath(channel: Channel): string | undefined {
  if (!crosses(channel)) return undefined;
  return prefix + [agentOf(channel.from), agentOf(channel.to)].sort().join("|");
}

/** The channels whose two ends both exist. */
export function connected(structure: Structure): Channel[] {
  const there = new Set(
    structure.agents.flatMap((agent) =>
      agent.subsystems.flatMap((one) => one.buffers.filter(({ direction }) => direction !== "real").map(({ path }) => path)),
    ),
  );
  return structure.channels.filter(({ from, to }) => there.has(withoutIndex(from)) && there.has(withoutIndex(to)));
}

export function bundlesOf(channels: readonly Channel[]): Bundle[] {
  const bundles = new Map<string, Bundle>();
  for (const channel of channels) {
    const path = bundlePath(channel);
    if (path === undefined) continue;
    const known = bundles.get(path);
    if (known) known.channels.push(channel.index);
    else bundles.set(path, { path, agents: path.slice(prefix.length).split("|") as [string, string], channels: [channel.index] });
  }
  return [...bundles.values()];
}

/** The bundle at a path, as it is now; undefined: no channel leads between these agents any more. */
export const bundleAt = (structure: Structure, path: string): Bundle | undefined =>
  bundlesOf(connected(structure)).find((one) => one.path === path);

/** "3 channels between carrier and dock". */
export const bundleTitle = ({ agents: [one, other], channels }: Bundle) =>
  `${channels.length} ${channels.length === 1 ? "channel" : "channels"} between ${one} and ${other}`;
