import type { MeasuredChain, MeasuredTimes, TimedChain } from "./protocol";
import { chainKey, shownTime } from "./timing";
import type { TimedRun } from "./timed_run";

/** Times of chains that were measured in a recording. */

/** Those of a chain; undefined: the recording has none. */
export const measuredOf = (all: readonly MeasuredChain[], chain: TimedChain): MeasuredChain | undefined =>
  all.find((one) => chainKey(one) === chainKey(chain));

/** The worst case as a run; undefined: nothing was measured. */
export const worstOf = ({ worst }: MeasuredTimes): TimedRun | undefined => worst;

export interface Histogram {
  /** Shares of the width and of the height, from the left and from the bottom. */
  bars: readonly { from: number; width: number; height: number; count: number; least_ns: number; most_ns: number }[];
  /** The time at the right edge. */
  end_ns: number;
  /** As shares of the width; null: there is none. */
  bound: number | null;
  worst: number;
}

/** Bars from 0 to a little more than the bound or the worst case; undefined: nothing was measured. */
export function histogramOf(
  { count, least_ns, most_ns, histogram }: MeasuredTimes,
  bound_ns: number | null,
): Histogram | undefined {
  if (count === 0 || least_ns === undefined || most_ns === undefined) return undefined;
  const end_ns = Math.max(most_ns, bound_ns ?? 0, 1) * 1.06;
  const counts = histogram && histogram.length > 0 ? histogram : [count];
  const step = (most_ns - least_ns) / counts.length;
  const greatest = Math.max(...counts);
  const bars = counts.flatMap((many, at) => {
    if (many === 0) return [];
    const [least, most] = [least_ns + at * step, least_ns + (at + 1) * step];
    return [{ from: least / end_ns, width: step / end_ns, height: many / greatest, count: many, least_ns: least, most_ns: most }];
  });
  return { bars, end_ns, bound: bound_ns === null ? null : bound_ns / end_ns, worst: most_ns / end_ns };
}

/** "A median of 61 ms, 99 % within 80 ms, 131 ms at most: 92 % of the bound." */
export function saidTimes({ count, median_ns, p99_ns, most_ns }: MeasuredTimes, bound_ns: number | null): string {
  if (count === 0 || median_ns === undefined || p99_ns === undefined || most_ns === undefined) return "nothing is measured";
  const share = bound_ns === null ? "" : `, ${Math.round((100 * most_ns) / bound_ns)} % of the bound`;
  const times = `${count.toLocaleString("en")} measured: median ${shownTime(median_ns)}, 99 % within ${shownTime(p99_ns)}`;
  return `${times}, longest ${shownTime(most_ns)}${share}`;
}
