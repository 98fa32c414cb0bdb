import type { Edit, OtherTimes, TimedSubsystem } from "./protocol";
import type { Structure, Subsystem } from "./structure/structure";
import { set } from "./text/edits";
import { shownRate, shownTime } from "./timing";

/** Other times of a subsystem, which the user tries. Absent: as the text says. */
export interface Tried {
  /** 0: no rate. */
  period_ns?: number;
  /** The longest time of a call. */
  longest_ns?: number;
}

/** The question that asks for the bounds with other times. A call cannot take longer than the longest one. */
export const whatIf = (tried: ReadonlyMap<string, Tried>, subsystems: readonly TimedSubsystem[]): OtherTimes[] =>
  [...tried].map(([path, { period_ns, longest_ns }]) => {
    const shortest = subsystems.find((one) => withoutMember(one.path) === path)?.shortest_ns ?? 0;
    return {
      path,
      ...(period_ns === undefined ? {} : { period_ns }),
      ...(longest_ns === undefined ? {} : { longest_ns, shortest_ns: Math.max(1, Math.min(shortest, longest_ns)) }),
    };
  });

const withoutMember = (path: string) => path.replace(/\[\d+\]/, "");

/** "robot.control at 40 Hz, with calls of 3 ms at most" */
export function saidTried(path: string, { period_ns, longest_ns }: Tried): string {
  const rate = period_ns === undefined ? "" : period_ns === 0 ? " without a rate" : ` at ${shownRate(period_ns)}`;
  const calls = longest_ns === undefined ? "" : `${rate ? "," : ""} with calls of ${shownTime(longest_ns)} at most`;
  return `${path}${rate}${calls}`;
}

const steps = [1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8];

/** The longest times of a call that a slider offers, from a tenth of the present one to ten times it. */
export function longestBeside(present_ns: number): number[] {
  const found = new Set([present_ns]);
  for (let power = 10 ** Math.floor(Math.log10(Math.max(10, present_ns)) - 1); power <= present_ns * 10; power *= 10)
    for (const step of steps) {
      const time = Math.round(step * power);
      if (time >= present_ns / 10 && time <= present_ns * 10) found.add(time);
    }
  return [...found].sort((a, b) => a - b);
}

const unitOf: Readonly<Record<string, number>> = { ns: 1, us: 1e3, ms: 1e6, s: 1e9 };

interface Range {
  shortest_ns: number;
  longest_ns: number;
}

/** "1..3 ms" or "2 ms"; undefined: another form. */
export function readTakes(text: string): Range | undefined {
  const [, first, firstUnit, second, unit] =
    /^\s*(\d+(?:\.\d+)?)\s*(ns|us|ms|s)?\s*(?:\.\.\s*(\d+(?:\.\d+)?)\s*(ns|us|ms|s)\s*)?$/.exec(text) ?? [];
  const scale = unit ?? firstUnit;
  if (first === undefined || scale === undefined) return undefined;
  const shortest_ns = Number(first) * unitOf[firstUnit ?? scale]!;
  return { shortest_ns, longest_ns: second === undefined ? shortest_ns : Number(second) * unitOf[scale]! };
}

/** The text of a range, in the largest unit in which the longest time is at least 1. */
export function takesText({ shortest_ns, longest_ns }: Range): string {
  const unit = ["s", "ms", "us", "ns"].find((one) => longest_ns >= unitOf[one]!) ?? "ns";
  const number = (ns: number) => String(Number((ns / unitOf[unit]!).toPrecision(12)));
  return shortest_ns === longest_ns ? `${number(longest_ns)} ${unit}` : `${number(shortest_ns)}..${number(longest_ns)} ${unit}`;
}

/**
 * The edits after which no call of a subsystem takes longer, and one may take so long: longer ranges end there, or the
 * longest one is extended. undefined: a behaviour says it in another form.
 */
export function takesEdits({ yaml }: Structure, subsystem: Subsystem, longest_ns: number): Edit[] | undefined {
  const ranges = subsystem.behaviours
    .filter(({ isGroup }) => !isGroup)
    .map((behaviour) => ({ at: behaviour.yaml, range: readTakes(yaml.followedText([...behaviour.yaml, "takes"]) ?? "") }));
  const known = ranges.flatMap(({ at, range }) => (range ? [{ at, range }] : []));
  if (known.length < ranges.length || known.length === 0) return undefined;
  const most = Math.max(...known.map(({ range }) => range.longest_ns));
  return known
    .filter(({ range }) => (longest_ns > most ? range.longest_ns === most : range.longest_ns > longest_ns))
    .map(({ at, range }) => set(at, "takes", takesText({ shortest_ns: Math.min(range.shortest_ns, longest_ns), longest_ns })));
}
