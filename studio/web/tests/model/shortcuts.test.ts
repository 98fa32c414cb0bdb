import { describe, expect, it } from "vitest";
import { keysInWords, shortcutOf, shortcuts } from "../../model/shortcuts";

const press = (key: string, ...held: ("ctrlKey" | "metaKey" | "altKey" | "shiftKey")[]) => ({
  key,
  ctrlKey: false,
  metaKey: false,
  altKey: false,
  shiftKey: false,
  ...Object.fromEntries(held.map((one) => [one, true])),
});

describe("shortcuts", () => {
  it("are those of the table, with Ctrl or Cmd", () => {
    expect(shortcutOf("everywhere", press("k", "ctrlKey"))).toBe("search");
    expect(shortcutOf("everywhere", press("s", "metaKey"))).toBe("save");
    expect(shortcutOf("everywhere", press("Z", "ctrlKey", "shiftKey"))).toBe("redo");
    expect(shortcutOf("everywhere", press("z", "ctrlKey"))).toBe("undo");
    expect(shortcutOf("everywhere", press("?", "shiftKey"))).toBe("help");
    expect(shortcutOf("net", press(" "))).toBe("enter");
    expect(shortcutOf("net", press("+", "shiftKey"))).toBe("nearer");
    expect(shortcutOf("net", press("-"))).toBe("farther");
  });

  it("leave other keys to the browser", () => {
    expect(shortcutOf("everywhere", press("k"))).toBeUndefined();
    expect(shortcutOf("everywhere", press("k", "ctrlKey", "altKey"))).toBeUndefined();
    expect(shortcutOf("net", press("0", "ctrlKey"))).toBeUndefined();
    expect(shortcutOf("net", press("f", "shiftKey"))).toBeUndefined();
  });

  it("have one meaning each in a group, and words for every key", () => {
    for (const group of Object.values(shortcuts)) {
      const keys = Object.values(group).flatMap((one) => [...one.keys]);
      expect(new Set(keys).size).toBe(keys.length);
    }
    expect(keysInWords("Mod-Shift-z")).toEqual(["Ctrl", "Shift", "Z"]);
    expect(keysInWords("-")).toEqual(["-"]);
    expect(keysInWords("Mod-]")).toEqual(["Ctrl", "]"]);
  });
});
