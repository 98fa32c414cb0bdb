import { describe, expect, it } from "vitest";
import type { Wait } from "../../../model/causes";
import { overlap, type Box } from "../../../model/net/geometry";
import { nameLines } from "../../../model/net/labels";
import { arrows } from "../../../model/structure/lens_layout";

const waits: Wait[] = [
  { who: "a", whom: "b", channel: "x", awaited: "acknowledgement" },
  { who: "b", whom: "a", channel: "y", awaited: "acknowledgement" },
];
const window = { x: 0, y: 0, width: 700, height: 640 };
const box = (x: number, y: number): Box => ({ x, y, width: 90, height: 110 });

describe("the labels of a chain of waiting", () => {
  it.each([
    ["above each other at the left rim", box(30, 60), box(30, 440)],
    ["above each other at the right rim", box(600, 60), box(600, 440)],
    ["beside each other", box(40, 300), box(560, 300)],
    ["in opposite corners", box(20, 20), box(590, 470)],
  ])("are whole within the window and cover nothing: %s", (_, a, b) => {
    const names = [{ x: 250, y: 250, width: 220, height: 24 }];
    const boxes = new Map([
      ["a", a],
      ["b", b],
    ]);
    const drawn = arrows(waits, boxes, names, window, 1);
    expect(drawn.map(({ text }) => text)).toEqual(["waits for the acknowledgement", "waits for the acknowledgement"]);
    for (const { label } of drawn) {
      expect(label.x >= 0 && label.x + label.width <= window.width, "within the window").toBe(true);
      expect(label.y >= 0 && label.y + label.height <= window.height, "within the window").toBe(true);
      for (const other of [a, b, ...names]) expect(overlap(label, other)).toBeUndefined();
    }
    expect(overlap(drawn[0]!.label, drawn[1]!.label)).toBeUndefined();
  });

  it("are drawn at an agent that stands for two of its subsystems", () => {
    const agent = box(300, 300);
    const boxes = new Map([
      ["a", agent],
      ["b", agent],
    ]);
    for (const { path } of arrows(waits, boxes, [], window, 1)) expect(path).not.toMatch(/NaN/);
  });
});

describe("nameLines", () => {
  it("breaks a name after underscores into lines of much the same length", () => {
    expect(nameLines("ball_collecting_vehicle_north", 2)).toEqual(["ball_collecting_", "vehicle_north"]);
    expect(nameLines("ball_collecting_vehicle_north", 3)).toHaveLength(3);
    expect(nameLines("gripper", 3)).toEqual(["gripper"]);
    expect(nameLines("a_b", 3)).toEqual(["a_", "b"]);
    for (const most of [1, 2, 3, 4]) expect(nameLines("one_two_three_four_five", most).join("")).toBe("one_two_three_four_five");
  });
});
