import { describe, expect, it } from "vitest";
import type { PanelControl } from "../../../model/protocol";
import { axisName, beyond, buttonName, padInputs, setupFrom, usualSetup, type Pad } from "../../../model/run/gamepad";

const control = (field: string, kind: PanelControl["control"], minimum: number | null, maximum: number | null): PanelControl => ({
  field,
  control: kind,
  unit: "",
  minimum,
  maximum,
  whole: false,
});
const controls = [
  control("turn", "stick_x", -2, 2),
  control("forward", "stick_y", -0.2, 0.5),
  control("horn", "button", null, null),
  control("light", "switch", null, null),
  control("gear", "slider", 1, 5),
];
const pad = (axes: number[], ...pressed: number[]): Pad => ({
  axes,
  buttons: Array.from({ length: 17 }, (_, at) => ({ pressed: pressed.includes(at) })),
  mapping: "standard",
});

describe("a gamepad", () => {
  const usual = usualSetup(controls, 0);

  it("moves the first panel by its left stick and first buttons, the second by its right stick", () => {
    expect(padInputs(controls, pad([1, -1, 0, 0], 0), usual)).toEqual({ turn: 2, forward: 0.5, horn: true });
    expect(padInputs(controls, pad([1, -1, 0, 1], 0), usualSetup(controls, 1))).toEqual({ forward: -0.2 });
    expect(padInputs(controls, pad([1, 1, 1, 1], 0), usualSetup(controls, 2))).toEqual({});
    expect(padInputs(controls, { axes: [], buttons: [] }, usual)).toEqual({});
  });

  it("moves nothing within its dead zone, and begins with nothing at its edge", () => {
    expect(padInputs(controls, pad([0.12, -0.1]), usual)).toEqual({});
    expect(beyond(0.12, 0.12)).toBe(0);
    expect(beyond(0.121, 0.12)).toBeLessThan(0.01);
    expect(beyond(-1, 0.12)).toBe(-1);
    expect(beyond(-1.2, 0.3)).toBe(-1);
  });

  it("moves nothing while its enable button is not held", () => {
    const setup = { ...usual, enable: 4 };
    expect(padInputs(controls, pad([1, -1], 0), setup)).toEqual({});
    expect(padInputs(controls, pad([1, -1], 0, 4), setup)).toEqual({ turn: 2, forward: 0.5, horn: true });
    expect(padInputs(controls, { axes: [1], buttons: [] }, setup)).toEqual({});
  });

  it("moves by other axes and buttons, reversed too, where the user wants it", () => {
    const setup = { ...usual, axes: { ...usual.axes, turn: { axis: 2, inverted: true }, forward: null }, buttons: { horn: 5 } };
    expect(padInputs(controls, pad([0, 0, 1, 0], 5), setup)).toEqual({ turn: -2, horn: true });
  });

  it("moves nothing by an axis that has not been at rest", () => {
    expect(padInputs(controls, pad([1, -1]), usual, (axis) => axis === 1)).toEqual({ forward: 0.5 });
  });

  it("keeps a setup, but no part that is wrong or of other controls", () => {
    expect(setupFrom(null, usual)).toEqual(usual);
    expect(setupFrom("no", usual)).toEqual(usual);
    const own = {
      ...usual,
      deadZone: 0.3,
      enable: 4,
      axes: { ...usual.axes, turn: null },
      buttons: { ...usual.buttons, horn: 7 },
    };
    expect(setupFrom(JSON.parse(JSON.stringify(own)), usual)).toEqual(own);
    const wrong = { deadZone: 7, enable: -1, axes: { turn: { axis: "x" }, gone: { axis: 1 } }, buttons: { horn: 1.5 } };
    expect(setupFrom(wrong, usual)).toEqual(usual);
  });

  it("has the names of a standard gamepad, or numbers", () => {
    expect(buttonName(4, pad([]))).toBe("left shoulder");
    expect(buttonName(4, { ...pad([]), mapping: "" })).toBe("button 4");
    expect(axisName(1, pad([]))).toBe("left stick, up and down");
    expect(axisName(9, pad([]))).toBe("axis 9");
  });
});
