import { diff } from "./merge";

/** The lines that an edit removes (-) and adds (+). */
export function changedLines(before: string, after: string): string[] {
  const old = before.split("\n");
  return diff(old, after.split("\n")).flatMap(({ from, to, lines }) => [
    ...old.slice(from, to).map((line) => `- ${line.trim()}`),
    ...lines.map((line) => `+ ${line.trim()}`),
  ]);
}
