import { diff } from "../../model/text/merge";

/** The changed lines, as in the diff of a commit. */
export function changes(before: string, after: string): string[] {
  const lines = before.split("\n");
  return diff(lines, after.split("\n")).flatMap((hunk) => [
    ...lines.slice(hunk.from, hunk.to).map((line) => `-${line}`),
    ...hunk.lines.map((line) => `+${line}`),
  ]);
}
