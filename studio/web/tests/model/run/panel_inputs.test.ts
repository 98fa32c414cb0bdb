import { describe, expect, it } from "vitest";
import type { PanelControl } from "../../../model/protocol";
import {
  deflected,
  deflectionOf,
  directionOf,
  neutralInputs,
  pushOf,
  released,
  stepOfSlider,
} from "../../../model/run/panel_inputs";

const control = (
  field: string,
  kind: PanelControl["control"],
  minimum: number | null = null,
  maximum: number | null = null,
  whole = false,
) => ({
  field,
  control: kind,
  unit: "",
  minimum,
  maximum,
  whole,
});
const controls = [
  control("turn", "stick_x", -2, 2),
  control("forward", "stick_y", -0.2, 0.5),
  control("horn", "button"),
  control("light", "switch"),
  control("gear", "slider", 1, 5, true),
];

describe("panel inputs", () => {
  it("are neutral as the controller has them without an operator", () => {
    expect(neutralInputs(controls)).toEqual({ turn: 0, forward: 0, horn: false, light: false, gear: 1 });
    expect(neutralInputs([control("below", "slider", -5, -2)])).toEqual({ below: -2 });
  });

  it("spring back where nobody holds them", () => {
    const held = { turn: 1, forward: 0.5, horn: true, light: true, gear: 4 };
    expect(released(controls, held)).toEqual({ turn: 0, forward: 0, horn: false, light: true, gear: 4 });
    expect(released(controls, held, true)).toEqual({ turn: 0, forward: 0, horn: false, light: true, gear: 1 });
  });

  it("reach the ends of a range whose zero is not in the middle", () => {
    const forward = controls[1]!;
    expect(deflected(forward, 1)).toBe(0.5);
    expect(deflected(forward, 0)).toBe(0);
    expect(deflected(forward, -1)).toBe(-0.2);
    expect(deflected(forward, -7)).toBe(-0.2);
    expect(deflected(control("n", "stick_x", -3, 3, true), 0.5)).toBe(2);
    for (const value of [-1, -0.5, 0, 0.25, 1]) expect(deflectionOf(forward, deflected(forward, value))).toBeCloseTo(value);
  });

  it("follow keys, and opposite keys cancel each other", () => {
    expect(pushOf(["up", "left"], false)).toEqual([-1, 1]);
    expect(pushOf(["up", "down"], false)).toEqual([0, 0]);
    expect(pushOf(["right"], true)[0]).toBeCloseTo(1 / 3);
    expect(directionOf("W", "both")).toBe("up");
    expect(directionOf("w", "arrows")).toBeUndefined();
    expect(directionOf("ArrowLeft", "arrows")).toBe("left");
    expect(directionOf("ArrowLeft", "letters")).toBeUndefined();
    expect(directionOf("q", "both")).toBeUndefined();
  });

  it("have steps of a slider that are round", () => {
    expect(stepOfSlider(control("speed", "slider", 0, 0.5))).toBe(0.001);
    expect(stepOfSlider(controls[4]!)).toBe(1);
  });
});
