import type { Edit, TimedChain, TimedChange, Timing } from "./protocol";
import { channelOf, findThing, withoutIndex, type Structure } from "./structure/structure";
import { append, insert, remove, set, setChannel } from "./text/edits";
import { shownRate } from "./timing";

/** Edits of a specification that change the times of a chain, and what is asked of them. */

/** A change in words. */
export function saidChange({ kind, subsystem, channel }: TimedChange): string {
  const who = withoutIndex(subsystem);
  const over = channel ? withoutIndex(channel).replace("->", " → ") : "";
  switch (kind) {
    case "twice_the_rate":
      return `Double the rate of ${who}`;
    case "event_driven":
      return `Let ${who} begin when a value comes over ${over}, without a rate`;
    case "receive_blocking":
      return `Let ${who} wait for the value of ${over}`;
    case "receive_non_blocking":
      return `Let ${who} not wait for the value of ${over}`;
    case "send_blocking":
      return `Let ${who} wait until the value of ${over} is taken`;
    case "send_non_blocking":
      return `Let ${who} not wait until the value of ${over} is taken`;
    case "own_processor":
      return `Give ${who} a processor of its own`;
  }
}

/** The edits of a change; undefined: the text has no place for it. */
export function editsOf(change: TimedChange, structure: Structure, timing: Timing): Edit[] | undefined {
  const thing = findThing(structure, withoutIndex(change.subsystem));
  const channel = change.channel === null ? undefined : channelOf(structure, change.channel);
  const timed = timing.subsystems.find(({ path }) => path === change.subsystem);
  if (thing?.kind !== "subsystem") return undefined;
  const { yaml } = thing.of;
  const wait = (end: "send" | "receive", mode: "blocking" | "non_blocking") => channel && [setChannel(channel, { [end]: mode })];
  switch (change.kind) {
    case "twice_the_rate":
      return timed && timed.period_ns > 0 ? [set(yaml, "rate", shownRate(timed.period_ns / 2))] : undefined;
    case "event_driven":
      if (!channel) return undefined;
      return [set(yaml, "rate", ""), ...(channel.receive === "blocking" ? [] : wait("receive", "blocking")!)];
    case "receive_blocking":
      return wait("receive", "blocking");
    case "receive_non_blocking":
      return wait("receive", "non_blocking");
    case "send_blocking":
      return wait("send", "blocking");
    case "send_non_blocking":
      return wait("send", "non_blocking");
    case "own_processor":
      return structure.yaml.pair([...yaml, "realtime", "cpu"]) ? [remove([...yaml, "realtime", "cpu"])] : undefined;
  }
}

/** The name of a chain that had none: "robot sensor to motor". */
export function givenName({ path }: Pick<TimedChain, "path">): string {
  const [agent, from] = withoutIndex(path[0]!).split(".");
  return `${agent} ${from} to ${withoutIndex(path.at(-1)!).split(".")[1]}`;
}

/** The path of a chain as the specification writes it: that of a fleet is one for each member. */
const pathOf = ({ path }: TimedChain) => path.map((one) => one.replace(/\[\d+\]/, "[i]"));

/** The entry of a chain in `timing: chains`; -1: it has none. */
export function entryOf({ yaml }: Structure, { named, name }: TimedChain): number {
  if (!named) return -1;
  const at = ["timing", "chains"];
  const names = (yaml.seq(at)?.items ?? []).map((_, index) => yaml.valueText([...at, index, "name"]));
  return names.indexOf(name) >= 0 ? names.indexOf(name) : names.indexOf(withoutIndex(name));
}

/**
 * The edits that ask for a limit of a chain; an empty text asks for none. Without entries every chain from a receptor to an
 * effector is judged: the first entry comes with the others, so that none is lost.
 */
export function limitEdits(
  structure: Structure,
  timing: Timing,
  chain: TimedChain,
  limit: "age" | "reaction",
  text: string,
): Edit[] {
  const at = entryOf(structure, chain);
  if (at >= 0) return [set(["timing", "chains", at], limit, text)];
  if (text === "") return [];
  // Members of a fleet with different verdicts are one entry of the text.
  const all = new Map(timing.chains.map((one) => [givenName(one), one]));
  all.set(givenName(chain), chain);
  const chains = [...all].map(([name, one]) => ({
    name,
    path: pathOf(one),
    ...(one === chain ? { [limit]: text } : {}),
  }));
  if (!structure.yaml.pair(["timing"])) return [insert([], "timing", { chains })];
  if (!structure.yaml.seq(["timing", "chains"])) return [insert(["timing"], "chains", chains)];
  return chains.map((one) => append(["timing", "chains"], one));
}
