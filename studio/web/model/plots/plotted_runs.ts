import type { Samples } from "../run/series";
import { ageOf, rateOf, type Arrivals } from "./arrivals";
import type { Curve } from "./drawn_curves";
import type { Signal } from "./signals";
import type { Lane } from "../run/timeline";

/** A run as the plots read it: one that goes on, or a recording. */
export interface PlottedRun {
  series: {
    samples: ReadonlyMap<string, Samples>;
    booleans: ReadonlySet<string>;
    values: (path: string) => Samples<unknown> | undefined;
  };
  arrivals: { byPath: ReadonlyMap<string, Arrivals> };
  timeline: { lanes: readonly Lane[] };
  /** The end of what is known, in nanoseconds. */
  end: number;
}

/** The changes of a state over time; "": none. */
export type States = { start: number; state: string }[];

/** Ages and rates that were worked out last, since an arrival changes them seldom. */
const known = new WeakMap<Arrivals, Map<string, { size: number; last: number; end: number; samples: Samples }>>();

/** Milliseconds of the run after which an age is worked out again, although nothing has arrived. */
const stale = 50e6;

function derived(arrivals: Arrivals, kind: "age" | "rate", end: number): Samples {
  const [size, last] = [arrivals.times.length, arrivals.times.at(-1) ?? 0];
  const kept = known.get(arrivals) ?? new Map<string, { size: number; last: number; end: number; samples: Samples }>();
  known.set(arrivals, kept);
  const before = kept.get(kind);
  if (before && before.size === size && before.last === last && Math.abs(end - before.end) < stale) return before.samples;
  const samples = (kind === "age" ? ageOf : rateOf)(arrivals, end);
  kept.set(kind, { size, last, end, samples });
  return samples;
}

/** The curve of a signal in a run; undefined: the run has none, or the signal has states and no numbers. */
export function curveOf(run: PlottedRun, { kind, path }: Signal, shift: number): Curve | undefined {
  const { end } = run;
  if (kind === "age" || kind === "rate") {
    const arrivals = run.arrivals.byPath.get(path);
    if (!arrivals) return undefined;
    return { samples: derived(arrivals, kind, end), course: kind === "age" ? "slope" : "hold", shift, until: end };
  }
  if (kind === "behaviour" || run.series.booleans.has(path)) return undefined;
  const samples = run.series.samples.get(path);
  return samples && { samples, course: "hold", shift, until: end };
}

/** The states of a signal that has states: a behaviour, a truth value, a text. undefined: it has none. */
export function statesOf(run: PlottedRun, { kind, path }: Signal): States | undefined {
  if (kind === "behaviour") {
    const lane = run.timeline.lanes.find((one) => one.path === path);
    return lane?.segments.map(({ start, behaviour }) => ({ start, state: behaviour }));
  }
  if (kind !== "value" || (run.series.samples.has(path) && !run.series.booleans.has(path))) return undefined;
  const values = run.series.values(path);
  if (!values) return undefined;
  const states: States = [];
  values.times.forEach((start, at) => {
    const value = values.values[at];
    const state = value === undefined ? "" : String(value);
    if (states.at(-1)?.state !== state) states.push({ start, state });
  });
  return states;
}

/** The first time at which a subsystem begins a behaviour; undefined: it never does. */
export const beginOf = (run: PlottedRun, path: string, behaviour: string): number | undefined =>
  run.timeline.lanes.find((one) => one.path === path)?.segments.find((one) => one.behaviour === behaviour)?.start;

/** The time of the first firing that is known; undefined: there is none. */
export function firstOf(run: PlottedRun): number | undefined {
  const starts = run.timeline.lanes.flatMap(({ firings }) => firings.slice(0, 1));
  return starts.length === 0 ? undefined : Math.min(...starts);
}
