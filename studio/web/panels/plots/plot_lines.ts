import type { Source } from "../../live/plots/plotted";
import type { PlotKept } from "../../live/plots/plots";
import { curveOf, statesOf } from "../../model/plots/plotted_runs";
import { keyOf, titleOf, unitOfSignal, type Signal } from "../../model/plots/signals";
import { statisticsOf, valueAt, type Statistics } from "../../model/plots/statistics";
import type { Structure } from "../../model/structure/structure";
import type { DrawnLine } from "./plot_charts";

/** A line of the plot with what its legend says. */
export interface PlotLine extends DrawnLine {
  signal: Signal;
  source: Source;
  /** Whether the legend has switched it off. */
  hidden: boolean;
}

const light = ["#1b6ca8", "#b4540a", "#1f7a44", "#7d3fb2", "#b3261e", "#0f7373", "#7a6200", "#4a5560"];
const dark = ["#6cb6ee", "#e09a55", "#6ecb92", "#c79bec", "#ff8a80", "#5fd0cf", "#d8c64d", "#b9c3cd"];
/** The dashes of the first, second, … run. */
const dashes: readonly (readonly number[])[] = [[], [6, 4], [2, 3], [8, 3, 2, 3], [12, 4]];

/** All lines of a plot: each signal in each run that has it. */
export function plotLines(kept: PlotKept, sources: readonly Source[], structure: Structure, isDark: boolean): PlotLine[] {
  const colours = isDark ? dark : light;
  return kept.signals.flatMap((signal, at) =>
    sources.flatMap((source, run): PlotLine[] => {
      const { track, shift } = source;
      const curve = curveOf(track, signal, shift);
      const changes = curve ? undefined : statesOf(track, signal);
      if (!curve && !changes) return [];
      const name = sources.length > 1 ? `${titleOf(signal)} (${source.name})` : titleOf(signal);
      return [
        {
          name,
          signal,
          source,
          unit: unitOfSignal(structure, signal),
          colour: colours[at % colours.length]!,
          dash: dashes[run % dashes.length]!,
          ...(curve ? { curve } : {}),
          ...(changes ? { states: { changes, shift, until: track.end } } : {}),
          invalid: curve ? invalidTimes(curve.samples.times, curve.samples.values, shift) : [],
          hidden: kept.hidden.includes(`${keyOf(signal)} ${source.name}`),
        },
      ];
    }),
  );
}

/** The times at which a curve breaks off. */
function invalidTimes(times: readonly number[], values: readonly number[], shift: number): number[] {
  const found: number[] = [];
  for (let at = 0; at < values.length; at += 1) if (Number.isNaN(values[at]!)) found.push(times[at]! + shift);
  return found;
}

/** The value of a line at a time, as a number or a state. */
export function readAt({ curve, states }: DrawnLine, time: number): number | string | undefined {
  if (curve) {
    if (time - curve.shift > curve.until) return undefined;
    const value = valueAt(curve.samples, time - curve.shift, curve.course);
    return Number.isNaN(value) ? undefined : value;
  }
  if (!states || time - states.shift > states.until) return undefined;
  let state: string | undefined;
  for (const { start, state: one } of states.changes) {
    if (start > time - states.shift) break;
    state = one;
  }
  return state || undefined;
}

export const factsOf = ({ curve }: DrawnLine, from: number, to: number): Statistics | null =>
  curve ? statisticsOf(curve.samples, from - curve.shift, to - curve.shift, curve.course, curve.until) : null;
