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
  it("keeps its begin and its end, since names of a system often begin alike", () => {
    expect(cutTo("autonomous_manipulator_01", 16)).toBe("autonomo…ator_01");
    expect(cutTo("autonomous_manipulator_01", 25)).toBe("autonomous_manipulator_01");
  });
  it("has more lines if the whole name is readable from farther away then", () => {
    const name = "autonomous_mobile_manipulator_for_cleanroom_logistics_01";
    expect(closedName(name, { x: 0, y: 0, width: 420, height: 140 }).lines.length).toBe(3);
    expect(closedName("robot", { x: 0, y: 0, width: 420, height: 140 }).lines.length).toBe(1);
  });
  it("has one text at a time for every size of its box", () => {
    const { cuts } = closedName("transportation_vehicle[12]", { x: 0, y: 0, width: 420, height: 290 });
    expect(cuts.length).toBeGreaterThan(2);
    for (let at = 1; at < cuts.length; at += 1) expect(cuts[at]!.from).toBe(cuts[at - 1]!.to);
  });
});
