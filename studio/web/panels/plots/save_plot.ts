import { csvOf } from "../../model/run/csv";
import { count } from "../../model/sorted";
import type { DrawnLine } from "./plot_charts";

/** Offers a file to the user. */
export function save(name: string, content: Blob): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(content);
  link.download = name;
  link.click();
  URL.revokeObjectURL(link.href);
}

/** The lines of a plot in a span of nanoseconds, as a table. */
export function csvOfLines(lines: readonly DrawnLine[], from: number, to: number): string {
  return csvOf(
    lines.map(({ name, unit, curve, states }) => {
      const shift = (curve ?? states)!.shift;
      const times = curve ? curve.samples.times : states!.changes.map(({ start }) => start);
      const values: readonly unknown[] = curve ? curve.samples.values : states!.changes.map(({ state }) => state);
      // With the value that holds where the span begins.
      const first = Math.max(0, count(times, (time) => time + shift <= from) - 1);
      const last = count(times, (time) => time + shift <= to);
      return {
        path: unit ? `${name} [${unit}]` : name,
        samples: {
          times: times.slice(first, last).map((time) => Math.max(from, time + shift)),
          values: values.slice(first, last),
        },
      };
    }),
  );
}
