import type { Samples } from "../run/series";

/** The least and the greatest value of a piece of samples, where they are, and whether there is a gap. */
export interface Extremes {
  low: number;
  high: number;
  lowAt: number;
  highAt: number;
  gap: boolean;
}

/** Samples whose extremes are worked out once. */
const size = 256;

const none = (): Extremes => ({ low: Infinity, high: -Infinity, lowAt: -1, highAt: -1, gap: false });

interface Blocks {
  /** The first time when they were worked out: an endless run drops its oldest samples. */
  begin: number;
  whole: Extremes[];
}

const known = new WeakMap<Samples, Blocks>();

function scan(values: readonly number[], from: number, to: number, into: Extremes): void {
  let { low, high, lowAt, highAt, gap } = into;
  for (let at = from; at < to; at += 1) {
    const value = values[at]!;
    if (value < low) {
      low = value;
      lowAt = at;
    }
    if (value > high) {
      high = value;
      highAt = at;
    }
    // Only NaN differs from itself.
    if (value !== value) gap = true;
  }
  into.low = low;
  into.high = high;
  into.lowAt = lowAt;
  into.highAt = highAt;
  into.gap = gap;
}

function join(into: Extremes, more: Extremes): void {
  if (more.low < into.low) {
    into.low = more.low;
    into.lowAt = more.lowAt;
  }
  if (more.high > into.high) {
    into.high = more.high;
    into.highAt = more.highAt;
  }
  into.gap ||= more.gap;
}

/** The extremes of the samples from one index up to another; a million samples are read only once. */
export function extremesOf(samples: Samples, from: number, to: number): Extremes {
  const { times, values } = samples;
  const found = none();
  if (to - from <= 2 * size) {
    scan(values, from, to, found);
    return found;
  }
  let blocks = known.get(samples);
  if (!blocks || blocks.begin !== times[0]) known.set(samples, (blocks = { begin: times[0]!, whole: [] }));
  const first = Math.ceil(from / size);
  const last = Math.floor(to / size);
  for (let block = blocks.whole.length; block < last; block += 1) {
    const one = none();
    scan(values, block * size, (block + 1) * size, one);
    blocks.whole.push(one);
  }
  scan(values, from, first * size, found);
  for (let block = first; block < last; block += 1) join(found, blocks.whole[block]!);
  scan(values, last * size, to, found);
  return found;
}
