import { describe, expect, it } from "vitest";
import { History } from "../../model/history";
import { clashesIn, diff, merge, mergeLines, splice, taking } from "../../model/text/merge";

describe("History", () => {
  it("undoes what was typed in one go at once, and redoes it", () => {
    const history = new History("a");
    history.change("ab", "typing", 0);
    history.change("abc", "typing", 100);
    history.change("abcd", "typing", 5000);
    expect(history.undo()).toBe("abc");
    expect(history.undo()).toBe("a");
    expect(history.undo()).toBeUndefined();
    expect(history.redo()).toBe("abc");
  });
  it("forgets what was undone when something else is done", () => {
    const history = new History("a");
    history.change("b", "edit", 0);
    history.undo();
    history.change("c", "edit", 1);
    expect(history.canRedo).toBe(false);
  });
});

describe("merge", () => {
  const base = "one\ntwo\nthree\nfour\nfive\n";
  it("takes both changes when they are apart", () => {
    expect(merge(base, base.replace("one", "ONE"), base.replace("five", "FIVE\nsix"))).toBe("ONE\ntwo\nthree\nfour\nFIVE\nsix\n");
  });
  it("asks when the same lines changed", () => {
    expect(merge(base, base.replace("two", "2"), base.replace("two", "zwei"))).toBeNull();
  });
  it("takes changes of neighbouring lines, but asks about two insertions at one place", () => {
    expect(merge(base, base.replace("two", "2"), base.replace("three", "drei"))).toBe("one\n2\ndrei\nfour\nfive\n");
    expect(merge(base, base.replace("two", "two\nmine"), base.replace("two", "two\ntheirs"))).toBeNull();
  });
  it("asks only about the lines that both changed, and keeps both changes elsewhere", () => {
    const mine = base.replace("one", "ONE").replace("three", "my three");
    const theirs = base.replace("three", "their three").replace("five", "FIVE");
    const parts = mergeLines(base, mine, theirs);
    expect(clashesIn(parts)).toEqual([{ line: 3, mine: ["my three"], theirs: ["their three"] }]);
    expect(taking(parts, "mine")).toBe("ONE\ntwo\nmy three\nfour\nFIVE\n");
    expect(taking(parts, "theirs")).toBe("ONE\ntwo\ntheir three\nfour\nFIVE\n");
  });
  it("loses no line that only one side changed, whatever both do", () => {
    let state = 7;
    const below = (limit: number) => Math.floor(((state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32) * limit);
    for (let round = 0; round < 500; round += 1) {
      const lines = Array.from({ length: 8 }, (_, at) => `line ${at}`);
      // Inserted lines have names of their own, so that each can be found again.
      const change = (who: string) =>
        lines.flatMap(
          (line, at) => [line, `${who} changes ${at}`, `${line}\n${who} inserts ${at}`, null][below(8)] ?? (below(9) ? line : []),
        );
      const [mine, theirs] = [change("a"), change("b")].map((all) => all.flat().join("\n")) as [string, string];
      const parts = mergeLines(lines.join("\n"), mine, theirs);
      const clashes = clashesIn(parts);
      const [my, their] = [taking(parts, "mine").split("\n"), taking(parts, "theirs").split("\n")];
      const inClash = (line: string) => clashes.some((one) => one.mine.includes(line) || one.theirs.includes(line));
      for (const line of [...mine.split("\n"), ...theirs.split("\n")].filter((one) => !one.startsWith("line")))
        if (!inClash(line))
          expect([my.includes(line), their.includes(line)], `${line} of\n${mine}\n--\n${theirs}`).toEqual([true, true]);
      if (clashes.length === 0) expect(my).toEqual(their);
    }
  });
  it("takes equal changes once", () => {
    const same = base.replace("two", "2");
    expect(merge(base, same, same)).toBe(same);
  });
  it("is undone by its own hunks", () => {
    const after = "zero\none\nthree\n4\nfive\n";
    const lines = base.split("\n");
    for (const hunk of diff(lines.slice(), after.split("\n")).reverse())
      lines.splice(hunk.from, hunk.to - hunk.from, ...hunk.lines);
    expect(lines.join("\n")).toBe(after);
  });
});

describe("splice", () => {
  it("replaces the smallest part", () => {
    expect(splice("rate: 20 Hz", "rate: 25 Hz")).toEqual({ from: 7, to: 8, insert: "5" });
    expect(splice("aa", "aaa")).toEqual({ from: 2, to: 2, insert: "a" });
  });
});
