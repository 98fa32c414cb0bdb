import type { Chain as ChainOfRun, TimedChain } from "./protocol";
import { withoutIndex } from "./structure/selection";
import { shownTime } from "./timing";

/** The times of chains that a run has measured. */

export type { ChainOfRun };

/** "robot[].eye", "robot[3].eye" and "robot.eye" have one name. */
const nameOfAll = (name: string): string =>
  name
    .split(" -> ")
    .map((one) => withoutIndex(one.replace("[]", "")))
    .join(" -> ");

/** The times of a chain of the specification in a run; of a fleet, the longest ones of all its members. */
export function chainOfRun(
  { named, name, path }: Pick<TimedChain, "named" | "name" | "path">,
  measured: readonly ChainOfRun[],
): ChainOfRun | undefined {
  const wanted = nameOfAll(named ? name : path.join(" -> "));
  return measured.find((one) => nameOfAll(one.name) === wanted);
}

/** A measured time beside the one that is proved for the running controller. */
export interface Measured {
  longest_ns: number;
  proved_ns: number | null;
  /** It exceeds what is proved. */
  exceeds: boolean;
}

const inNs = (seconds: number): number => Math.round(seconds * 1e9);

/** The longest time so far; null: there is none yet. */
export function longestOf(chain: ChainOfRun | undefined, what: "age" | "reaction"): Measured | null {
  const longest = what === "age" ? chain?.longest_age_s : chain?.longest_reaction_s;
  const proved = what === "age" ? chain?.proved_age_s : chain?.proved_reaction_s;
  if (longest === undefined) return null;
  const [longest_ns, proved_ns] = [inNs(longest), proved === undefined ? null : inNs(proved)];
  return { longest_ns, proved_ns, exceeds: proved_ns !== null && longest_ns > proved_ns };
}

/** "measured: 79 ms", with what differs from the bound that the panel shows. */
export function saidMeasured({ longest_ns, proved_ns, exceeds }: Measured, shownBound_ns: number | null): string {
  const said = `measured: ${shownTime(longest_ns)}`;
  if (exceeds && proved_ns !== null) return `${said}, over ${shownTime(proved_ns)}`;
  return proved_ns !== null && proved_ns !== shownBound_ns ? `${said} (the run has ${shownTime(proved_ns)})` : said;
}
