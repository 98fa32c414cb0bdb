import type { YamlPath, YamlText } from "../text/yaml_text";
import type { Structure, Subsystem } from "./structure";

/** A memory cell that is part of the net. */
export interface KeptCell {
  name: string;
  /** The range of a counter: "0..4"; empty: it has values. */
  counts: string;
  values: string[];
}

/** The memory of a subsystem that `sets` changes. */
export function keptCells({ yaml }: Structure, subsystem: Subsystem): KeptCell[] {
  const memory = [...subsystem.yaml, "memory"];
  return yaml.keys(memory).flatMap((name) => {
    const cell = keptCell(yaml, [...memory, name]);
    return cell ? [cell] : [];
  });
}

/** The memory cell at a path; undefined: it has a type. */
export function keptCell(yaml: YamlText, at: YamlPath): KeptCell | undefined {
  if (!yaml.pair([...at, "values"]) && !yaml.pair([...at, "counts"])) return undefined;
  const values = (yaml.seq([...at, "values"])?.items ?? []).map((_, index) => yaml.valueText([...at, "values", index]) ?? "");
  return { name: String(at.at(-1)), counts: yaml.valueText([...at, "counts"]) ?? "", values };
}

/** The memory cell at a path holds the life of a goal. */
export const isGoal = (yaml: YamlText, at: YamlPath): boolean => yaml.pair([...at, "goal"]) !== undefined;

/** The names of the memory of a subsystem that holds goals. */
export function goalsOf({ yaml }: Structure, subsystem: Subsystem): string[] {
  const memory = [...subsystem.yaml, "memory"];
  return yaml.keys(memory).filter((name) => isGoal(yaml, [...memory, name]));
}

/** `sets` that fits the cells: "{ lent_to: a, served: +1 }". */
export function exampleOf(cells: readonly KeptCell[]): string {
  // "each robot" stands for the values of the members.
  const value = (text: string) => text.replace(/^\s*each\s+(\w+)\s*$/, '"$1[0]"');
  const changes = cells
    .slice(0, 2)
    .map((one) => `${one.name}: ${one.counts ? "+1" : value(one.values[1] ?? one.values[0] ?? "a")}`);
  return `{ ${changes.join(", ")} }`;
}
