/** A type of the specification in parts: "float64[8] m/s", "string<=64", "Pose<=16". */
export interface TypeParts {
  base: string;
  /** The largest number of characters of a text; empty: it is none. */
  most: string;
  /** The number of elements: "8", "each robot" for one of each member of a fleet, or "<=16" for a sequence of at most so many; empty: it is no array. */
  length: string;
  unit: string;
}

export const numberTypes = [
  "float64",
  "float32",
  "int8",
  "int16",
  "int32",
  "int64",
  "uint8",
  "uint16",
  "uint32",
  "uint64",
] as const;
export const plainTypes: readonly string[] = ["bool", ...numberTypes, "string"];

export const isNumber = (base: string) => (numberTypes as readonly string[]).includes(base);

/** null: the text is no type. */
export function typeParts(text: string): TypeParts | null {
  const found =
    /^\s*(?:(string)\b\s*(?:<=\s*(\d+))?|([A-Za-z_]\w*))\s*(?:\[\s*(\d+|each\s+\w+)\s*\]|<=\s*(\d+))?\s*(.*?)\s*$/.exec(text);
  if (!found) return null;
  const [, string, most = "", other = "", extent = "", largest, unit = ""] = found;
  const length = largest === undefined ? extent : `<=${largest}`;
  return /[<[\]{}"]/.test(unit) ? null : { base: string ?? other, most, length, unit };
}

/** Only texts have a largest length, and only numbers a unit. */
export function typeText({ base, most, length, unit }: TypeParts): string {
  const limit = base === "string" ? `<=${most || "64"}` : "";
  const elements = !length || length.startsWith("<=") ? length : `[${length}]`;
  return `${base}${limit}${elements}${isNumber(base) && unit ? ` ${unit}` : ""}`;
}
