import { count } from "../sorted";
import type { Samples } from "../run/series";

/** How a curve goes from one sample to the next: a value holds, an age grows. */
export type Course = "hold" | "slope";

/** Facts about a signal in a span of time. */
export interface Statistics {
  min: number;
  max: number;
  /** Over time: a value counts as long as it holds. */
  mean: number;
  /** The standard deviation over time. */
  std: number;
  /** The number of samples in the span. */
  count: number;
  /** Samples per second. */
  rate: number;
}

/** The value at a time; NaN: there is none. */
export function valueAt({ times, values }: Samples, time: number, course: Course = "hold"): number {
  const after = count(times, (one) => one <= time);
  if (after === 0) return NaN;
  const before = values[after - 1]!;
  if (course === "hold" || after === times.length) return before;
  const part = (time - times[after - 1]!) / (times[after]! - times[after - 1]!);
  return before + part * (values[after]! - before);
}

/** null: there is no valid value in the span. Times in nanoseconds. `until`: the end of what is known. */
export function statisticsOf(samples: Samples, from: number, to: number, course: Course = "hold", until = to): Statistics | null {
  const { times, values } = samples;
  const end = Math.min(to, until);
  if (end < from) return null;
  const first = count(times, (time) => time < from);
  const last = count(times, (time) => time <= end);
  let [min, max, seconds, sum, squares, samplesInside] = [Infinity, -Infinity, 0, 0, 0, 0];
  const take = (value: number) => {
    min = Math.min(min, value);
    max = Math.max(max, value);
  };
  const piece = (begin: number, finish: number, one: number, other: number) => {
    const next = course === "hold" ? one : other;
    if (Number.isNaN(one) || Number.isNaN(next)) return;
    take(one);
    take(next);
    const length = (finish - begin) / 1e9;
    seconds += length;
    sum += (length * (one + next)) / 2;
    squares += (length * (one * one + one * next + next * next)) / 3;
  };
  let [time, value] = [from, valueAt(samples, from, course)];
  for (let at = first; at < last; at += 1) {
    // An age that drops has two samples at one time.
    if (!Number.isNaN(values[at]!) && times[at + 1] !== times[at]) samplesInside += 1;
    piece(time, times[at]!, value, values[at]!);
    if (!Number.isNaN(values[at]!)) take(values[at]!);
    [time, value] = [times[at]!, values[at]!];
  }
  piece(time, end, value, value);
  if (min > max) return null;
  const mean = seconds > 0 ? sum / seconds : value;
  const std = seconds > 0 ? Math.sqrt(Math.max(0, squares / seconds - mean * mean)) : 0;
  return { min, max, mean, std, count: samplesInside, rate: end > from ? samplesInside / ((end - from) / 1e9) : 0 };
}
