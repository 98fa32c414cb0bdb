import type { ParameterShown } from "../protocol";

/** How a parameter of a run is shown and changed. */

export type Control = "switch" | "slider" | "number" | "text";

const isInteger = (type: string) => /^u?int(8|16|32|64)$/.test(type);
const isNumber = (type: string) => isInteger(type) || /^float(32|64)$/.test(type);

/** A slider needs a range; a value that is neither a number nor a bool is typed. */
export function controlOf({ type, minimum, maximum }: ParameterShown): Control {
  if (type === "bool") return "switch";
  if (!isNumber(type)) return "text";
  return minimum !== null && maximum !== null && minimum < maximum ? "slider" : "number";
}

/** The step of a slider: about a hundred of them, a round number, and whole for whole numbers. */
export function stepOf({ type, minimum, maximum }: ParameterShown): number {
  const fine = 10 ** Math.floor(Math.log10(((maximum ?? 1) - (minimum ?? 0)) / 100));
  return isInteger(type) ? Math.max(1, fine) : fine;
}

/** Two texts of one value: "0.20" is "0.2". */
export function same(one: string, other: string, type: string): boolean {
  return isNumber(type) ? Number(one) === Number(other) : one === other;
}
