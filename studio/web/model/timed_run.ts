import type { TimedCall, TimedHop } from "./protocol";

/** Runs of a chain, from a reading or an event to a command, and their places in a drawing. */

/** The time of a chain that a run shows. */
export type Shown = "age" | "reaction";

/** A run of a chain: from the reading, or an event just after it, to the end of the command. Times in nanoseconds. */
export interface TimedRun {
  from_ns: number;
  to_ns: number;
  /** The calls of its subsystems meanwhile. */
  calls: readonly TimedCall[];
  /** The way of the value; empty: it is not known. */
  hops: readonly TimedHop[];
}

/** A part of the time, in the order of the run: they add up to it. */
export interface RunPart {
  kind: "works" | "stands" | "waits";
  /** The number of the subsystem on the chain. */
  lane: number;
  from: number;
  to: number;
  text: string;
}

const last = (path: string) => path.slice(path.indexOf(".") + 1);

/** The subsystems of a run, from the receptor on. */
export const lanesOf = ({ hops }: TimedRun, path: readonly string[]): readonly string[] =>
  hops.length > 0 ? [hops[0]!.from, ...hops.map(({ to }) => to)] : path;

/** The calls through which the value goes, one for each subsystem; undefined: its call is not known. */
export function carriersOf(run: TimedRun, path: readonly string[]): (TimedCall | undefined)[] {
  const { hops, to_ns: to, calls } = run;
  if (hops.length === 0) return [];
  return lanesOf(run, path).map((subsystem, lane) => {
    const until = hops[lane]?.written_ns ?? to;
    const own = calls.filter((call) => call.subsystem === subsystem && call.end_ns <= until);
    return own.reduce<TimedCall | undefined>((latest, one) => (latest && latest.end_ns > one.end_ns ? latest : one), undefined);
  });
}

/** The parts of the time of a run, in their order; none: the way of the value is not known. */
export function partsOf(run: TimedRun, path: readonly string[], shown: Shown): RunPart[] {
  const { hops, from_ns: from, to_ns: to } = run;
  const lanes = lanesOf(run, path);
  const carriers = carriersOf(run, path);
  const parts: RunPart[] = [];
  let now = from;
  const add = (kind: RunPart["kind"], lane: number, until: number, text: string) => {
    if (until > now) parts.push({ kind, lane, from: now, to: until, text });
    now = Math.max(now, until);
  };
  carriers.forEach((call, lane) => {
    const who = last(lanes[lane]!);
    if (call) {
      const before =
        lane === 0
          ? `${who} has just read its device: until it reads again`
          : lane === carriers.length - 1 && shown === "age"
            ? `until ${who} begins its last call that uses the value`
            : `until the next call of ${who} begins, which uses the value`;
      add("waits", lane, call.begin_ns, before);
      add("works", lane, call.end_ns, `${who} computes (${call.behaviour})`);
    }
    const hop = hops[lane];
    if (!hop) return add("waits", lane, to, `until the command of ${who} is given`);
    add("waits", lane, hop.written_ns, `${who} waits in its sends`);
    add("stands", lane, hop.read_ns, `the value waits in the channel until ${last(hop.to)} receives it`);
  });
  return parts;
}

/** Pixels of the drawing of a run. */
export const runSizes = { side: 10, top: 40, lane: 50, name: 15, bar: 18, below: 26 } as const;

/** The free time beside a run, as a share of it. */
const margin = 0.04;

export interface DrawnCall {
  call: TimedCall;
  lane: number;
  x: number;
  y: number;
  width: number;
  /** The value of the command goes through it. */
  carries: boolean;
}

export interface DrawnRun {
  height: number;
  lanes: readonly { subsystem: string; y: number }[];
  calls: readonly DrawnCall[];
  parts: readonly (RunPart & { x: number; y: number; width: number })[];
  /** The way of the value, from the first mark to the last one. */
  line: readonly { x: number; y: number }[];
  /** From where the value is written to where it is read. */
  arrows: readonly { hop: TimedHop; x1: number; y1: number; x2: number; y2: number }[];
  begin: { x: number; y: number };
  end: { x: number; y: number };
  x: (time: number) => number;
  /** The time at a distance from the left edge. */
  timeAt: (x: number) => number;
}

/** The places of all parts of a run in a drawing of this width. */
export function drawnRun(run: TimedRun, path: readonly string[], shown: Shown, width: number): DrawnRun {
  const { side, top, lane: laneHeight, name, bar, below } = runSizes;
  const free = Math.max(1, run.to_ns - run.from_ns) * margin;
  const [first, final] = [run.from_ns - free, run.to_ns + free];
  const scale = (width - 2 * side) / (final - first);
  const x = (time: number) => side + (Math.min(final, Math.max(first, time)) - first) * scale;
  const timeAt = (at: number) => Math.min(final, Math.max(first, first + (at - side) / scale));
  const lanes = lanesOf(run, path).map((subsystem, at) => ({ subsystem, y: top + at * laneHeight + name }));
  const middle = (lane: number) => lanes[lane]!.y + bar / 2;
  const carriers = carriersOf(run, path);
  const calls = run.calls.flatMap((call): DrawnCall[] => {
    const lane = lanes.findIndex(({ subsystem }) => subsystem === call.subsystem);
    if (lane < 0 || call.end_ns < first || call.begin_ns > final) return [];
    const left = x(call.begin_ns);
    // A call that takes no time is seen, too.
    return [
      { call, lane, x: left, y: lanes[lane]!.y, width: Math.max(2, x(call.end_ns) - left), carries: carriers[lane] === call },
    ];
  });
  const parts = partsOf(run, path, shown).map((part) => ({
    ...part,
    x: x(part.from),
    y: lanes[part.lane]!.y,
    width: x(part.to) - x(part.from),
  }));
  const arrows = run.hops.map((hop, at) => ({
    hop,
    x1: x(hop.written_ns),
    y1: middle(at),
    x2: x(hop.read_ns),
    y2: middle(at + 1),
  }));
  const begin = { x: x(run.from_ns), y: middle(0) };
  const end = { x: x(run.to_ns), y: middle(lanes.length - 1) };
  const line =
    run.hops.length === 0
      ? []
      : [
          begin,
          ...arrows.flatMap(({ x1, y1, x2, y2 }) => [
            { x: x1, y: y1 },
            { x: x2, y: y2 },
          ]),
          end,
        ];
  return { height: top + lanes.length * laneHeight + below, lanes, calls, parts, line, arrows, begin, end, x, timeAt };
}
