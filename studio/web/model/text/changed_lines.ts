import { diff } from "./merge";

/** The places at which two texts differ: the lines of each. */
export function changedBlocks(before: string, after: string): { old: string[]; fresh: string[] }[] {
  const all = before.split("\n");
  return diff(all, after.split("\n")).map(({ from, to, lines }) => ({ old: all.slice(from, to), fresh: [...lines] }));
}

/** The lines that an edit removes (-) and adds (+). */
export const changedLines = (before: string, after: string): string[] =>
  changedBlocks(before, after).flatMap(({ old, fresh }) => [
    ...old.map((line) => `- ${line.trim()}`),
    ...fresh.map((line) => `+ ${line.trim()}`),
  ]);
