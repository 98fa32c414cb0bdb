import { describe, expect, it } from "vitest";
import { closedName, cutTo } from "../../canvas/net/closed_name";

describe("a cut name", () => {
  it("keeps the number of a member of a fleet while there is room for it", () => {
    expect(cutTo("robot[536]", 10)).toBe("robot[536]");
    expect(cutTo("robot[536]", 8)).toBe("ro…[536]");
    expect(cutTo("robot[536]", 7)).toBe("r…[536]");
    expect(cutTo("robot[536]", 6)).toBe("robot…");
    expect(cutTo("dispatcher", 6)).toBe("dispa…");
  });
  it("has one text at a time for every size of its box", () => {
    const { cuts } = closedName("transportation_vehicle[12]", { x: 0, y: 0, width: 420, height: 290 });
    expect(cuts.length).toBeGreaterThan(2);
    for (let at = 1; at < cuts.length; at += 1) expect(cuts[at]!.from).toBe(cuts[at - 1]!.to);
  });
});
