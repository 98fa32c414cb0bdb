import type { Samples } from "./series";

const quoted = (text: string) => (/[",\n\r]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
const cell = (value: unknown) => (value === undefined || value === null || Number.isNaN(value) ? "" : quoted(String(value)));

/**
 * A table of values over time: a row for each time at which one of them changed. Times in seconds. An empty cell: there is
 * no valid value.
 */
export function csvOf(series: readonly { path: string; samples: Samples<unknown> }[]): string {
  const times = [...new Set(series.flatMap(({ samples }) => samples.times))].sort((a, b) => a - b);
  const at = series.map(() => -1);
  const rows = times.map((time) =>
    [
      (time / 1e9).toFixed(9),
      ...series.map(({ samples }, column) => {
        while (samples.times[at[column]! + 1] !== undefined && samples.times[at[column]! + 1]! <= time) at[column]! += 1;
        return cell(samples.values[at[column]!]);
      }),
    ].join(","),
  );
  return [["time_s", ...series.map(({ path }) => quoted(path))].join(","), ...rows, ""].join("\n");
}
