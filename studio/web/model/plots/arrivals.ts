import { bounded, count } from "../sorted";
import type { Samples } from "../run/series";

/** The new values of one input. Times in nanoseconds. */
export interface Arrivals {
  /** When the reader got them. */
  times: number[];
  /** When the sender wrote them; NaN: not known, since some arrivals are not listed. */
  written: number[];
  valid: boolean[];
}

/** The number of arrivals of an input that are kept in an endless run. */
const most = 20_000;

/** The new values that came through channels, by path of the input that got them. */
export class ArrivalLog {
  readonly byPath = new Map<string, Arrivals>();
  /** Whether some were too many to be listed. */
  interrupted = false;

  constructor(private readonly limit = most) {}

  /** The inputs that ever got a value. */
  get paths(): string[] {
    return [...this.byPath.keys()].sort();
  }

  add(path: string, time: number, written: number, valid: boolean): void {
    let known = this.byPath.get(path);
    if (!known) this.byPath.set(path, (known = { times: [], written: [], valid: [] }));
    bounded(known.times, this.limit).push(time);
    bounded(known.written, this.limit).push(written);
    bounded(known.valid, this.limit).push(valid);
  }

  /** From then on some arrivals are missing, until the next one of each input. */
  interrupt(time: number): void {
    this.interrupted = true;
    for (const path of this.byPath.keys()) this.add(path, time, NaN, true);
  }

  isInvalid(path: string): boolean {
    return this.byPath.get(path)?.valid.at(-1) === false;
  }
}

/**
 * The age of an input in seconds: the time since its sender wrote the value that it holds. It grows until the next value
 * comes, so the samples are joined by slopes. NaN: there is no valid value.
 */
export function ageOf({ times, written, valid }: Arrivals, end: number): Samples {
  const age: Samples = { times: [], values: [] };
  const add = (time: number, value: number) => {
    age.times.push(time);
    age.values.push(value);
  };
  times.forEach((time, at) => {
    const before = at > 0 && valid[at - 1]! ? written[at - 1]! : NaN;
    if (!Number.isNaN(before)) add(time, (time - before) / 1e9);
    add(time, valid[at]! ? (time - written[at]!) / 1e9 : NaN);
  });
  const last = valid.at(-1) ? written.at(-1)! : NaN;
  if (!Number.isNaN(last) && end > times.at(-1)!) add(end, (end - last) / 1e9);
  return age;
}

/** Nanoseconds in which arrivals are counted. */
const second = 1e9;

/** The number of valid new values in the last second, at each time at which it changes. It holds until the next one. */
export function rateOf({ times, written, valid }: Arrivals, end: number): Samples {
  const rate: Samples = { times: [], values: [] };
  const add = (time: number, value: number) => {
    if (rate.times.at(-1) === time) rate.values[rate.values.length - 1] = value;
    else {
      rate.times.push(time);
      rate.values.push(value);
    }
  };
  const come = times.filter((_, at) => valid[at] && !Number.isNaN(written[at]!));
  const gaps = times.filter((_, at) => Number.isNaN(written[at]!));
  // From then on all values are known.
  let since = times[0] ?? 0;
  let [left, gap] = [0, 0];
  const until = (time: number, right: number) => {
    // Values leave the second one after the other.
    for (; left < right && come[left]! + second <= time; left += 1) add(come[left]! + second, right - left - 1);
  };
  const interrupted = (time: number, right: number) => {
    for (; gap < gaps.length && gaps[gap]! <= time; gap += 1) {
      until(gaps[gap]!, right);
      add(gaps[gap]!, NaN);
      // Some are missing until the next one.
      [since, left] = [come[right] ?? Infinity, right];
    }
  };
  come.forEach((time, at) => {
    interrupted(time, at);
    until(time, at);
    // Before a whole second has passed, the number would be too low.
    if (time >= since + second) add(time, at - left + 1);
  });
  interrupted(end, come.length);
  until(end, come.length);
  // Before the first whole second there is no rate, either.
  const first = count(rate.times, (time) => time < (times[0] ?? 0) + second);
  return { times: rate.times.slice(first), values: rate.values.slice(first) };
}
