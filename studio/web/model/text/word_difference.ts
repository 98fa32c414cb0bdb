import { diffWordsWithSpace } from "diff";

/** A part of a text; `changed`: the other text does not have it. */
export interface Part {
  text: string;
  changed: boolean;
}

/** The lines of two texts, in parts: which words differ. A line without any word of the other text is changed as a whole. */
export function wordDifference(old: readonly string[], fresh: readonly string[]): { old: Part[][]; fresh: Part[][] } {
  const parts = diffWordsWithSpace(old.join("\n"), fresh.join("\n"));
  const side = (other: "added" | "removed", mine: "added" | "removed", count: number): Part[][] => {
    const lines: Part[][] = [[]];
    for (const part of parts) {
      if (part[other]) continue;
      part.value.split("\n").forEach((text, at) => {
        if (at > 0) lines.push([]);
        if (text !== "") lines.at(-1)!.push({ text, changed: part[mine] === true });
      });
    }
    return count === 0 ? [] : lines;
  };
  return { old: side("added", "removed", old.length), fresh: side("removed", "added", fresh.length) };
}
