import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { agentFilled, detailAt, levelsOf, structureStep, subsystemFilled } from "../../../model/structure/levels";
import { readStructure } from "../../../model/structure/structure";
import { drawStructure } from "../../../model/structure/structure_graph";
import { estimated, fitted, fontSize, lineHeight, remembered, wrapped } from "../../../model/structure/text_size";
import { elk } from "../line_follower";

const letter = estimated("a", "text");

describe("a text in a width", () => {
  it("breaks at spaces and behind underscores, and keeps all letters", () => {
    expect(wrapped("memory.charge < 0.3 && in.line", 16.5 * letter, estimated)).toEqual(["memory.charge <", "0.3 && in.line"]);
    expect(wrapped("three_fingered_gripper", 15.5 * letter, estimated)).toEqual(["three_fingered_", "gripper"]);
    expect(wrapped("short", 1000, estimated)).toEqual(["short"]);
  });
  it("breaks a word only if asked, and no short one", () => {
    const word = "transportationvehicle";
    expect(wrapped(word, 10 * letter, estimated)).toEqual([word]);
    expect(wrapped(word, 10 * letter, estimated, "text", true)).toEqual(["transporta", "tionvehicle"]);
    expect(wrapped("gripper", 3 * letter, estimated, "text", true)).toEqual(["gripper"]);
  });
});

it("a name has the largest letters that fit, and at least ten pixels", () => {
  const room = { width: 100, height: 40 };
  const found = fitted("three_fingered", room, 16, estimated, "agent")!;
  expect(found.lines.join("")).toBe("three_fingered");
  expect(found.size).toBeGreaterThanOrEqual(10);
  for (const line of found.lines)
    expect((estimated(line, "agent") * found.size) / fontSize.agent).toBeLessThanOrEqual(room.width);
  expect(found.lines.length * found.size * lineHeight).toBeLessThanOrEqual(room.height);
  expect(fitted("three_fingered", { width: 20, height: 40 }, 16, estimated, "agent")).toBeUndefined();
});

it("a text is measured once", () => {
  let asked = 0;
  const measure = remembered((text) => ((asked += 1), text.length));
  expect([measure("a", "text"), measure("a", "text"), measure("a", "agent")]).toEqual([1, 1, 1]);
  expect(asked).toBe(2);
});

it("from each level of the zoom on, all names of that level fit, and just below it one does not", async () => {
  const spec = readFileSync(new URL("../../e2e/projects/long_names/spec.yaml", import.meta.url), "utf8");
  const structure = readStructure(spec);
  const drawing = await drawStructure(structure, elk, estimated);
  const levels = levelsOf(structure, drawing, estimated);
  expect(levels.agents).toBeLessThan(levels.subsystems);
  expect(levels.subsystems).toBeLessThan(levels.all);
  expect(levels.all * fontSize.text).toBeGreaterThanOrEqual(10);
  const agents = (zoom: number) =>
    structure.agents.every((one) => agentFilled(one, drawing.boxes.get(one.name)!, zoom, estimated));
  for (let zoom = levels.agents; zoom < levels.all; zoom = structureStep(zoom * 1.05)) expect(agents(zoom), `${zoom}`).toBe(true);
  expect(agents(levels.agents / 2 ** (1 / 16))).toBe(false);
  const subsystems = structure.agents.flatMap((one) => one.subsystems);
  for (let zoom = levels.subsystems; zoom < levels.all; zoom = structureStep(zoom * 1.05))
    for (const one of subsystems) expect(subsystemFilled(one, drawing.boxes.get(one.path)!, zoom, estimated)).toBeDefined();
  expect([levels.agents, levels.subsystems, levels.all].map((zoom) => detailAt(zoom, levels))).toEqual([
    "agents",
    "subsystems",
    "all",
  ]);
});
