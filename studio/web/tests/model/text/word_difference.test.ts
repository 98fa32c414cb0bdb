import { expect, test } from "vitest";
import { changedBlocks } from "../../../model/text/changed_lines";
import { wordDifference } from "../../../model/text/word_difference";

const marked = (lines: { text: string; changed: boolean }[][]) =>
  lines.map((line) => line.map(({ text, changed }) => (changed ? `[${text}]` : text)).join(""));

test("only the words that differ are marked", () => {
  const { old, fresh } = wordDifference(["rate: 20 Hz # fast"], ["rate: 25 Hz # fast"]);
  expect(marked(old)).toEqual(["rate: [20] Hz # fast"]);
  expect(marked(fresh)).toEqual(["rate: [25] Hz # fast"]);
});

test("each line stays a line, whatever was added or removed", () => {
  const { old, fresh } = wordDifference(["a: 1"], ["a: 1", "b: 2"]);
  expect(marked(old)).toEqual(["a: 1"]);
  expect(marked(fresh)).toEqual(["a: 1", "[b: 2]"]);
  expect(wordDifference([], ["new"])).toEqual({ old: [], fresh: [[{ text: "new", changed: true }]] });
  expect(wordDifference(["", "x"], [""]).old).toHaveLength(2);
});

test("a text is its parts again", () => {
  const [before, after] = ["a\nb: { c: 1, d: 2 }\ne\n", "a\nb: { c: 3, d: 2 }\nf\ne\n"];
  for (const { old, fresh } of changedBlocks(before, after)) {
    const parts = wordDifference(old, fresh);
    expect(parts.old.map((line) => line.map(({ text }) => text).join(""))).toEqual(old);
    expect(parts.fresh.map((line) => line.map(({ text }) => text).join(""))).toEqual(fresh);
  }
});
