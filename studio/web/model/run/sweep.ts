import type { ParameterShown, SweepRow } from "../protocol";

/** The fields of a sweep as the user has typed them. */
export interface SweepTyped {
  /** Path; empty: only the seeds differ. */
  parameter: string;
  from: string;
  to: string;
  steps: string;
  runs: string;
  seed: string;
  duration: string;
}

export type SweepField = keyof SweepTyped;
export type SweepMistakes = Partial<Record<SweepField, string>>;

/** Limits of the server. */
export const most = { values: 200, runs: 10_000 };

/** The parameters that can be varied: numbers. Those of the members of a fleet are one, `robot[*].control.v`. */
export function sweptParameters(parameters: readonly ParameterShown[]): ParameterShown[] {
  const numbers = parameters.filter(({ type }) => /^(float|int|uint)\d+$/.test(type));
  const pattern = ({ path }: ParameterShown) => path.replace(/\[\d+\]/g, "[*]");
  const counts = new Map<string, number>();
  for (const one of numbers) counts.set(pattern(one), (counts.get(pattern(one)) ?? 0) + 1);
  const found = new Map<string, ParameterShown>();
  for (const one of numbers) {
    const path = counts.get(pattern(one))! > 1 ? pattern(one) : one.path;
    if (!found.has(path)) found.set(path, { ...one, path });
  }
  return [...found.values()];
}

const isWhole = (text: string) => /^\s*\d+\s*$/.test(text);

/** A number with or without the unit of the parameter; NaN: it is none, or has another unit. */
export function numberWithUnit(text: string, unit: string): number {
  const [, digits, given = ""] = /^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*(.*?)\s*$/i.exec(text) ?? [];
  return digits !== undefined && (given === "" || given === unit) ? Number(digits) : NaN;
}

/** The values of the parameter, evenly apart, as the server takes them; or what is wrong with which field. */
export function sweptValues(
  typed: SweepTyped,
  parameter: ParameterShown | undefined,
): { values: string[]; mistakes: SweepMistakes } {
  const mistakes: SweepMistakes = {};
  const whole = (field: "runs" | "seed" | "steps", least: number, greatest: number) => {
    const number = Number(typed[field]);
    if (!isWhole(typed[field]) || number < least || number > greatest)
      mistakes[field] = `a whole number from ${least} to ${greatest}`;
    return number;
  };
  const runs = whole("runs", 1, most.runs);
  whole("seed", 0, 9e15);
  if (!/^\s*\d+(\.\d+)?\s*(s|ms|min)?\s*$/.test(typed.duration) || parseFloat(typed.duration) === 0)
    mistakes.duration = "a time such as 10s or 2min";
  if (typed.parameter === "") return { values: [], mistakes };
  if (!parameter) return { values: [], mistakes: { ...mistakes, parameter: "there is no such parameter" } };
  const { unit, minimum, maximum, type } = parameter;
  const steps = whole("steps", 2, most.values);
  if (!mistakes.steps && !mistakes.runs && steps * runs > most.runs)
    mistakes.runs = `${steps} values × ${runs} runs are more than ${most.runs.toLocaleString("en")}`;
  const end = (field: "from" | "to") => {
    const number = numberWithUnit(typed[field], unit);
    if (Number.isNaN(number)) mistakes[field] = unit ? `a number in ${unit}` : "a number";
    else if (minimum !== null && number < minimum) mistakes[field] = `at least ${minimum} ${unit}`.trim();
    else if (maximum !== null && number > maximum) mistakes[field] = `at most ${maximum} ${unit}`.trim();
    return number;
  };
  const [from, to] = [end("from"), end("to")];
  if (!mistakes.from && !mistakes.to && from === to) mistakes.to = "another number than the first one";
  if (Object.keys(mistakes).length > 0) return { values: [], mistakes };
  const numbers = Array.from({ length: steps }, (_, at) => {
    const number = from + ((to - from) * at) / (steps - 1);
    // The last digits are those of the division.
    return type.startsWith("float") ? Number(number.toPrecision(12)) : Math.round(number);
  });
  return { values: [...new Set(numbers)].map((number) => (unit ? `${number} ${unit}` : String(number))), mistakes };
}

/** Facts about one measure at one value of the parameter. */
export interface SweptPoint {
  value: string;
  /** The number in it. */
  x: number;
  runs: number;
  failed: number;
  /** Facts about the runs that took the measure; null: none did. */
  numbers: { min: number; mean: number; max: number; std: number; count: number } | null;
}

const usual = ["failed", "firings", "overruns", "errors", "simulated time"];

/** The measures of the rows: those of the world first. */
export function measuresOf(rows: readonly SweepRow[]): string[] {
  const names = [...new Set(rows.flatMap(({ numbers }) => Object.keys(numbers)))];
  return names.sort((a, b) => usual.indexOf(a) - usual.indexOf(b) || (a < b ? -1 : 1));
}

/** A point of the curve for each value, in the order of the numbers. */
export function sweptPoints(rows: readonly SweepRow[], measure: string): SweptPoint[] {
  const byValue = new Map<string, SweepRow[]>();
  for (const row of rows) byValue.set(row.value, [...(byValue.get(row.value) ?? []), row]);
  return [...byValue]
    .map(([value, all]) => {
      const taken = all.flatMap(({ numbers }) => (typeof numbers[measure] === "number" ? [numbers[measure]] : []));
      const failed = all.filter((one) => one.failed).length;
      return { value, x: parseFloat(value), runs: all.length, failed, numbers: factsOf(taken) };
    })
    .sort((a, b) => a.x - b.x);
}

function factsOf(numbers: readonly number[]): SweptPoint["numbers"] {
  if (numbers.length === 0) return null;
  let [min, max, sum] = [Infinity, -Infinity, 0];
  for (const one of numbers) [min, max, sum] = [Math.min(min, one), Math.max(max, one), sum + one];
  const mean = sum / numbers.length;
  const squares = numbers.reduce((all, one) => all + (one - mean) ** 2, 0);
  // It is that of a sample: the true mean is not known.
  const std = numbers.length > 1 ? Math.sqrt(squares / (numbers.length - 1)) : 0;
  return { min, mean, max, std, count: numbers.length };
}

/** The number of runs in each of some equal ranges of a measure. */
export function distributionOf(rows: readonly SweepRow[], measure: string): { from: number; to: number; runs: number }[] {
  const numbers = rows.flatMap((row) => (typeof row.numbers[measure] === "number" ? [row.numbers[measure]] : []));
  const facts = factsOf(numbers);
  if (!facts) return [];
  const { min, max } = facts;
  if (min === max) return [{ from: min, to: max, runs: numbers.length }];
  const bins = Math.max(1, Math.min(40, Math.ceil(Math.sqrt(numbers.length))));
  const width = (max - min) / bins;
  const counts = new Array<number>(bins).fill(0);
  for (const one of numbers) counts[Math.min(bins - 1, Math.floor((one - min) / width))]! += 1;
  return counts.map((runs, at) => ({ from: min + at * width, to: min + (at + 1) * width, runs }));
}
