import { describe, expect, it } from "vitest";
import { History } from "../../model/history";
import { diff, merge, splice } from "../../model/text/merge";

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
