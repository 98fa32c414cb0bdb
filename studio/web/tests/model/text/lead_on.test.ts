import { describe, expect, it } from "vitest";
import { readStructure } from "../../../model/structure/structure";
import { arrowEdits, terminalWith, type NewArrow } from "../../../model/text/lead_on";
import { behaviour } from "../edited_example";

const at = ["agents", "a", "control", "behaviours", "run"];
const run = (text: string) =>
  behaviour(readStructure(`agents: { a: { control: { behaviours: { run: ${text}, wait: {} } } } }`), "a.control.run");
const arrow = (text: string, fields: Partial<NewArrow>) => arrowEdits(run(text), { to: "wait", when: "", ends: true, ...fields });
const terminal = (text: string) => ({ do: "set", at, key: "terminal", text, as: "scalar" });
const next = (fields: object, key?: string) => ({ do: "next", at, fields, ...(key === undefined ? {} : { key }) });

describe("a new arrow", () => {
  it("gives a behaviour without an end its terminal condition", () => {
    expect(arrow("{}", { when: "memory.low" })).toEqual({
      edits: [terminal("memory.low"), next({ to: "wait", when: "" })],
      entry: 0,
    });
  });
  it("adds its condition to the terminal condition, and stands before the arrow that is always taken", () => {
    expect(arrow("{ terminal: in.a && in.b, next: { to: end, sets: { x: 1 } } }", { when: "memory.low" })).toEqual({
      edits: [
        terminal("(in.a && in.b) || memory.low"),
        next({ to: "wait", when: "memory.low", sets: "" }, "0"),
        next({ to: "end", when: "", sets: "{ x: 1 }" }),
      ],
      entry: 0,
    });
  });
  it("leaves the terminal condition if the user says so, or after a failure", () => {
    expect(arrow("{}", { when: "memory.low", ends: false }).edits).toEqual([next({ to: "wait", when: "memory.low" })]);
    expect(arrow("{ next: end }", { when: "error" })).toEqual({ edits: [next({ to: "wait", when: "error" })], entry: 1 });
  });
  it("combines no names, endings with names, and conditions that are in it", () => {
    const both = (text: string, when: string) => terminalWith(run(text), when);
    expect(both("{}", "low")).toBe("low");
    for (const text of ["true", "low", "{ low: in.a }", "in.b || in.x"])
      expect(both(`{ terminal: ${text} }`, "in.x")).toBeUndefined();
    expect(both("{ terminal: memory.b < 20 }", "memory.b < 2")).toBe("memory.b < 20 || memory.b < 2");
    expect(both("{ terminal: in.a }", "low")).toBeUndefined();
  });
});
