import type { TimedBound, TimedChain, TimedStep, Timing } from "./protocol";
import { withoutIndex } from "./structure/structure";

/** Chains and their times in words. */

const units = [
  { ns: 1e9, name: "s" },
  { ns: 1e6, name: "ms" },
  { ns: 1e3, name: "us" },
] as const;

/** "82 ms": at most four digits, rounded up, since a bound must not be told too small. */
export function shownTime(ns: number): string {
  const unit = units.find((one) => ns >= one.ns);
  if (!unit) return `${ns} ns`;
  let step = unit.ns / 1000;
  while (ns / step >= 10_000) step *= 10;
  return `${Number(((Math.ceil(ns / step) * step) / unit.ns).toFixed(3))} ${unit.name}`;
}

/** "82 ms", or that there is no bound. */
export const shownBound = (at_most_ns: number | null): string => (at_most_ns === null ? "no bound" : shownTime(at_most_ns));

/** "20 Hz" */
export const shownRate = (period_ns: number): string =>
  period_ns === 0 ? "no rate" : `${Number((1e9 / period_ns).toPrecision(6))} Hz`;

/** Periods of whole microseconds, many of which divide each other: the pattern of all subsystems repeats soon. */
const usualRates = [1, 2, 4, 5, 8, 10, 16, 20, 25, 40, 50, 80, 100, 125, 200, 250, 400, 500, 1000];

/** The periods that a slider offers, the slowest rate first; the present one is among them. */
export const periodsBeside = (present_ns: number): number[] =>
  [...new Set([...usualRates.map((rate) => 1e9 / rate), ...(present_ns > 0 ? [present_ns] : [])])].sort((a, b) => b - a);

/** The words of a path without what they have in common: "robot: sensor → control → motor". */
export function chainTitle(path: readonly string[]): string {
  const agents = new Set(path.map((one) => one.split(".")[0]));
  const names = path.map((one) => (agents.size === 1 ? one.slice(one.indexOf(".") + 1) : one)).join(" → ");
  return agents.size === 1 ? `${[...agents][0]}: ${names}` : names;
}

/** The name that the specification gives it, or its subsystems. */
export const chainName = ({ named, name, path, agents }: TimedChain): string =>
  named ? (agents > 1 ? withoutIndex(name) : name) : chainTitle(path);

/** No behaviour says what it takes, and nothing is asked. */
export const isSilent = ({ chains }: Timing): boolean =>
  chains.every((one) => one.why !== "" && one.age.asked_ns === null && one.reaction.asked_ns === null);

/** Names a chain also after an edit, and whichever member of a fleet stands for it. */
export const chainKey = ({ path, name, named }: Pick<TimedChain, "path" | "name" | "named">): string =>
  named ? withoutIndex(name) : path.map(withoutIndex).join(" ");

export type Verdict = "holds" | "violated" | "unknown" | "none";

/** The verdict on a chain: the worse one of its age and its reaction. Without a bound, nothing is known. */
export function verdictOf({ age, reaction, why }: TimedChain): Verdict {
  const answers = [age.answer, reaction.answer];
  if (answers.includes("violated")) return "violated";
  if (answers.includes("unknown") || answers.includes("none") || why !== "") return "unknown";
  return answers.includes("holds") ? "holds" : "none";
}

/** How many chains take longer than was asked, and of how many that is not known. */
export function timesOf(timing: Timing | null): { late: number; unproved: number } {
  const asked = (timing?.chains ?? []).filter(({ age, reaction }) => age.asked_ns !== null || reaction.asked_ns !== null);
  const count = (verdict: Verdict) =>
    asked.filter((one) => verdictOf(one) === verdict).reduce((sum, { agents }) => sum + agents, 0);
  return { late: count("violated"), unproved: count("unknown") };
}

/** A verdict in plain words. */
export function saidChain({ age, reaction, why }: TimedChain): string {
  if (why) return `No bound: ${why}.`;
  const time = ({ at_most_ns }: TimedBound) => (at_most_ns === null ? "any time" : shownTime(at_most_ns));
  const asked = (name: string, bound: TimedBound) =>
    bound.asked_ns === null ? "" : ` (asked: ${name} of ${shownTime(bound.asked_ns)} or less)`;
  const old = `A command is at most ${time(age)} old${asked("an age", age)}`;
  return `${old}; an event is answered within ${time(reaction)}${asked("a reaction", reaction)}.`;
}

const last = (path: string) => path.slice(path.indexOf(".") + 1);

/** A part of an age or a reaction in words. */
export function saidStep({ kind, subsystem, channel }: TimedStep, isAge: boolean): string {
  const who = last(subsystem);
  switch (kind) {
    case "next_reading":
      return `${who} has just read its device: until it reads again`;
    case "until_read":
      return `the value waits in the channel${channel ? ` to ${last(channel.split("->")[1] ?? "")}` : ""} until ${who} receives it${isAge ? " for the last time" : ""}`;
    case "until_begin":
      return `until the next iteration of ${who} begins, which uses the value`;
    case "latency":
      return `${who} goes on later than it may (latency)`;
    case "processor":
      return `${who} waits for its processor`;
    case "takes":
      return `${who} computes`;
    case "until_sent":
      return `${who} waits in other sends`;
  }
}

/** The subsystems of a chain with their shares of a time, and the parts of each. */
export interface Share {
  subsystem: string;
  ns: number;
  parts: readonly TimedStep[];
}

/** Parts of one subsystem that follow one another are its share. */
export function sharesOf(steps: readonly TimedStep[]): Share[] {
  const shares: { subsystem: string; ns: number; parts: TimedStep[] }[] = [];
  for (const step of steps) {
    let mine = shares.at(-1);
    if (mine?.subsystem !== step.subsystem) shares.push((mine = { subsystem: step.subsystem, ns: 0, parts: [] }));
    mine.ns += step.ns;
    mine.parts.push(step);
  }
  return shares;
}

/** The chain to show: the chosen one, or else the first that breaks what was asked. */
export function shownChain(timing: Timing | null, chosen: string | null): TimedChain | null {
  const chains = timing?.chains ?? [];
  return (
    chains.find((one) => chainKey(one) === chosen) ?? chains.find((one) => verdictOf(one) === "violated") ?? chains[0] ?? null
  );
}

/** Chains that break what was asked come first, and then those of which it is unknown. */
export function worstFirst(chains: readonly TimedChain[]): TimedChain[] {
  const order: Record<Verdict, number> = { violated: 0, unknown: 1, holds: 2, none: 3 };
  return chains
    .map((chain, at) => ({ chain, at }))
    .sort((a, b) => order[verdictOf(a.chain)] - order[verdictOf(b.chain)] || a.at - b.at)
    .map(({ chain }) => chain);
}
