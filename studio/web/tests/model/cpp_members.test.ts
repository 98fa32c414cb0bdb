import { readFileSync } from "node:fs";
import { expect, test } from "vitest";
import { contextMembers, cppMembers, pathBefore } from "../../model/text/cpp_members";
import { readStructure } from "../../model/structure/structure";

const example = (name: string) => readStructure(readFileSync(`../../examples/${name}/spec.yaml`, "utf8"));
const lineFollower = example("01_line_follower");
const namesAt = (structure: typeof lineFollower, subsystem: string, path: string[]) => {
  const found = structure.agents.flatMap((agent) => agent.subsystems).find((one) => one.path === subsystem)!;
  return cppMembers(structure, found, path).map(({ name }) => name);
};

test("buffers, memory and parameters of the subsystem are proposed, and the fields of their types", () => {
  expect(namesAt(lineFollower, "robot.control", [])).toEqual(["in", "memory", "out", "context"]);
  expect(namesAt(lineFollower, "robot.control", ["in"])).toEqual(["line"]);
  expect(namesAt(lineFollower, "robot.control", ["in", "line"])).toEqual(["left", "middle", "right"]);
  expect(namesAt(lineFollower, "robot.control", ["out", "motion"])).toEqual(["linear", "angular"]);
  expect(namesAt(lineFollower, "robot.control", ["in", "line", "left"])).toEqual([]);
  expect(namesAt(lineFollower, "robot.control", ["other", "line"])).toEqual([]);
  expect(namesAt(lineFollower, "robot.motor", ["context", "parameters"])).toEqual(["r", "b", "v", "w"]);
  expect(namesAt(example("02_gap"), "robot.control", ["memory"])).toEqual(["side", "searched"]);
});

test("a receptor reads its real buffers, and an effector writes them", () => {
  expect(namesAt(lineFollower, "robot.sensor", ["in"])).toEqual(["left", "middle", "right"]);
  expect(namesAt(lineFollower, "robot.sensor", ["out"])).toEqual(["line"]);
  expect(namesAt(lineFollower, "robot.motor", ["in"])).toEqual(["velocity"]);
  expect(namesAt(lineFollower, "robot.motor", ["out"])).toEqual(["left", "right"]);
});

test("the path before the cursor is found in any expression", () => {
  expect(pathBefore("  out.motion = in.line.le")).toEqual(["in", "line"]);
  expect(pathBefore("  if (!in.")).toEqual(["in"]);
  expect(pathBefore("  x = in.scan[i + 1].ra")).toEqual(["in", "scan"]);
  expect(pathBefore("  me")).toEqual([]);
  expect(pathBefore("  x = ")).toBe(null);
});

test("the members of the context are those of its header", () => {
  const header = readFileSync("../../runtime/include/tessera/context.hpp", "utf8");
  for (const { name } of contextMembers.filter((one) => one.name !== "parameters"))
    expect(header, name).toMatch(new RegExp(`\\b${name}(\\{|\\(| = )`));
});
