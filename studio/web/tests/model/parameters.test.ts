import { describe, expect, it } from "vitest";
import type { ParameterShown } from "../../model/protocol";
import { controlOf, same, stepOf } from "../../model/run/parameters";

const shown = (known: Partial<ParameterShown>): ParameterShown => ({
  path: "robot.v",
  type: "float64",
  unit: "m/s",
  minimum: null,
  maximum: null,
  initial: "0.2",
  value: "0.2",
  differs: false,
  ...known,
});

describe("a parameter of a run", () => {
  it("has a slider where it has a range, and else what fits its type", () => {
    expect(controlOf(shown({ minimum: 0, maximum: 1 }))).toBe("slider");
    expect(controlOf(shown({ minimum: 0 }))).toBe("number");
    expect(controlOf(shown({ minimum: 1, maximum: 1 }))).toBe("number");
    expect(controlOf(shown({ type: "bool" }))).toBe("switch");
    expect(controlOf(shown({ type: "string", minimum: 0, maximum: 1 }))).toBe("text");
    expect(controlOf(shown({ type: "float64[6]" }))).toBe("text");
  });
  it("moves in round steps, in whole ones if it counts", () => {
    expect(stepOf(shown({ minimum: 0, maximum: 1 }))).toBeCloseTo(0.01);
    expect(stepOf(shown({ minimum: -0.3, maximum: 0.3 }))).toBeCloseTo(0.001);
    expect(stepOf(shown({ type: "int32", minimum: 0, maximum: 5 }))).toBe(1);
    expect(stepOf(shown({ type: "uint16", minimum: 0, maximum: 1000 }))).toBe(10);
  });
  it("is the same number however it is written", () => {
    expect(same("0.20", "0.2", "float64")).toBe(true);
    expect(same("0.20", "0.2", "string")).toBe(false);
    expect(same("a", "b", "string")).toBe(false);
  });
});
