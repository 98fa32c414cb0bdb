import { count } from "../sorted";
import type { Samples } from "./series";
import type { Timeline } from "./timeline";

/** A run as the comparison of values reads it. */
export interface ComparedRun {
  series: { paths: readonly string[]; values: (path: string) => Samples<unknown> | undefined };
  timeline: Pick<Timeline, "lanes">;
  /** The end of what is known, in nanoseconds. */
  end: number;
}

/** The first value that two runs do not share. */
export interface FirstDifference {
  path: string;
  /** Nanoseconds: where the earlier one of both changes. */
  time: number;
  /** undefined: the run has no value by then. */
  values: readonly [unknown, unknown];
  /** The subsystem that holds the value, and its iteration by then; null: it is not known. */
  subsystem: string;
  iteration: number | null;
}

/** 0 and -0 are the same, and so are two numbers that are none. */
const isSame = (one: unknown, other: unknown) => one === other || Object.is(one, other);

/** The changes of a value, without those that set it to what it was. */
function changesOf(samples: Samples<unknown> | undefined): { times: number[]; values: unknown[] } {
  const changes: { times: number[]; values: unknown[] } = { times: [], values: [] };
  samples?.values.forEach((value, at) => {
    if (changes.values.length > 0 && isSame(changes.values.at(-1), value)) return;
    changes.times.push(samples.times[at]!);
    changes.values.push(value);
  });
  return changes;
}

/**
 * The first change of a value that the other run does not have. Both are compared change by change; a change that is the
 * same, but more than `tolerance` nanoseconds earlier or later, is a difference, too. A part that one of them has not reached
 * yet is none. null: there is no difference.
 */
export function firstDifference(one: ComparedRun, other: ComparedRun, tolerance = 0): FirstDifference | null {
  const until = Math.min(one.end, other.end);
  let first: FirstDifference | null = null;
  for (const path of new Set([...one.series.paths, ...other.series.paths])) {
    const [left, right] = [changesOf(one.series.values(path)), changesOf(other.series.values(path))];
    const most = Math.max(left.times.length, right.times.length);
    for (let at = 0; at < most; at += 1) {
      const [mine, theirs] = [left.times[at] ?? Infinity, right.times[at] ?? Infinity];
      const time = Math.min(mine, theirs);
      if (time > until - tolerance || (first && time >= first.time)) break;
      if (isSame(left.values[at], right.values[at]) && Math.abs(mine - theirs) <= tolerance) continue;
      const valueAt = ({ times, values }: typeof left) => values[count(times, (each) => each <= time) - 1];
      // Within the tolerance both have changed.
      const close = Math.abs(mine - theirs) <= tolerance;
      const values = close ? ([left.values[at], right.values[at]] as const) : ([valueAt(left), valueAt(right)] as const);
      first = { path, time, values, ...placeOf(one, path, time) };
      break;
    }
  }
  return first;
}

function placeOf({ timeline }: ComparedRun, path: string, time: number): Pick<FirstDifference, "subsystem" | "iteration"> {
  const lane = timeline.lanes.find((one) => path.startsWith(`${one.path}.`));
  if (!lane) return { subsystem: "", iteration: null };
  const iteration = lane.calls.length > 0 && lane.since === -Infinity ? count(lane.calls, (call) => call <= time) : null;
  return { subsystem: lane.path, iteration: iteration || null };
}
