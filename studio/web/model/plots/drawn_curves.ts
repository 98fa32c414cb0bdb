import { count } from "../sorted";
import { extremesOf } from "./extremes";
import type { Samples } from "../run/series";
import { valueAt, type Course } from "./statistics";

/** A curve as it is drawn. */
export interface Curve {
  samples: Samples;
  course: Course;
  /** Added to its times, in nanoseconds. */
  shift: number;
  /** The end of what is known, on its own clock. */
  until: number;
}

/** Points with common times, as uPlot wants them: seconds, then the values of each curve; null: a gap. */
export type Table = [number[], ...(number | null)[][]];

/** Up to so many points a pixel, each sample is drawn. */
const most = 2;

/**
 * The points of curves in a span: all samples while they are few, otherwise the least and the greatest value of each of
 * the columns, so that no peak is lost. A gap in a column is drawn as a gap. Times in nanoseconds.
 */
export function drawnCurves(curves: readonly Curve[], from: number, to: number, columns: number): Table {
  const inside = curves.map(({ samples: { times }, shift }) => ({
    first: count(times, (time) => time + shift < from),
    last: count(times, (time) => time + shift <= to),
  }));
  const samples = inside.reduce((sum, { first, last }) => sum + last - first, 0);
  return samples <= most * columns ? every(curves, inside, from, to) : columned(curves, inside, from, to, columns);
}

type Inside = readonly { first: number; last: number }[];

const shown = (value: number, curve: Curve, time: number) =>
  Number.isNaN(value) || time - curve.shift > curve.until ? null : value;

function every(curves: readonly Curve[], inside: Inside, from: number, to: number): Table {
  const times = new Set([from, to]);
  curves.forEach(({ samples, shift, until }, at) => {
    const { first, last } = inside[at]!;
    for (let one = first; one < last; one += 1) times.add(samples.times[one]! + shift);
    if (until + shift > from && until + shift < to) times.add(until + shift);
  });
  const sorted = [...times].sort((a, b) => a - b);
  // Two samples at one time, as where an age drops, are two points.
  const points = sorted.flatMap((time) => {
    const twice = curves.some(({ samples, shift }) => {
      const after = count(samples.times, (one) => one + shift <= time);
      return after > 1 && samples.times[after - 2] === samples.times[after - 1] && samples.times[after - 1]! + shift === time;
    });
    return twice ? [time, time] : [time];
  });
  return [
    points.map((time) => time / 1e9),
    ...curves.map((curve) => {
      const { samples, shift, course } = curve;
      return points.map((time, at) => {
        const isFirstOfTwo = points[at + 1] === time;
        if (isFirstOfTwo) {
          const here = count(samples.times, (one) => one + shift < time);
          if (samples.times[here]! + shift === time) return shown(samples.values[here]!, curve, time);
        }
        return shown(valueAt(samples, time - shift, course), curve, time);
      });
    }),
  ];
}

function columned(curves: readonly Curve[], inside: Inside, from: number, to: number, columns: number): Table {
  const width = (to - from) / columns;
  const times: number[] = [];
  for (let column = 0; column < columns; column += 1)
    times.push((from + column * width) / 1e9, (from + (column + 0.5) * width) / 1e9);
  return [
    times,
    ...curves.map((curve, at) => {
      const { samples, shift, course } = curve;
      const { first, last } = inside[at]!;
      const points: (number | null)[] = [];
      let one = first;
      for (let column = 0; column < columns; column += 1) {
        const begin = from + column * width;
        const end = begin + width;
        const next = end >= to ? last : count(samples.times, (time) => time + shift < end);
        const { low, high, lowAt, highAt, gap } = extremesOf(samples, one, Math.max(one, next));
        one = Math.max(one, next);
        if (low > high) {
          const held = gap ? null : shown(valueAt(samples, begin - shift, course), curve, begin);
          points.push(held, gap ? null : held);
        } else if (lowAt <= highAt) points.push(low, gap ? null : high);
        else points.push(high, gap ? null : low);
      }
      return points;
    }),
  ];
}

/** A state over a span of time. */
export interface Band {
  from: number;
  to: number;
  state: string;
}

/** The states of a row of bands in a span; states that are narrower than a column are left out. */
export function bandsOf(
  changes: readonly { start: number; state: string }[],
  from: number,
  to: number,
  until: number,
  columns: number,
): Band[] {
  const least = (to - from) / columns;
  const bands: Band[] = [];
  const first = Math.max(0, count(changes, ({ start }) => start <= from) - 1);
  for (let at = first; at < changes.length && changes[at]!.start < to; at += 1) {
    const { start, state } = changes[at]!;
    const end = Math.min(changes[at + 1]?.start ?? until, to, until);
    const begin = Math.max(start, from, bands.at(-1)?.to ?? -Infinity);
    if (state === "" || end <= begin) continue;
    const before = bands.at(-1);
    if (before && before.state === state && begin - before.to < least) before.to = end;
    else bands.push({ from: begin, to: Math.max(end, begin + least), state });
  }
  return bands;
}
