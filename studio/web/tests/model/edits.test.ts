import { describe, expect, it } from "vitest";
import type { Edit } from "../../model/protocol";
import * as edits from "../../model/text/edits";
import { findThing, readStructure, thingAt, type Buffer } from "../../model/structure/structure";
import { behaviour, example, structure, subsystem } from "./edited_example";

describe("readStructure", () => {
  it("reads agents, subsystems, buffers and channels", () => {
    expect(structure.agents[0]!.subsystems.map((one) => `${one.kind} ${one.path} ${one.rate}`)).toEqual([
      "control robot.control 20 Hz",
      "receptor robot.sensor 50 Hz",
      "effector robot.motor 50 Hz",
    ]);
    expect(structure.channels[1]).toMatchObject({
      from: "robot.control.motion",
      to: "robot.motor.velocity",
      send: "non_blocking",
      receive: "blocking",
      timeout: "200 ms",
    });
  });
  it("says what is on a line", () => {
    expect(thingAt(structure, 19)).toBe("robot.control.follow");
    expect(thingAt(structure, 22)).toBe("robot.sensor");
    expect(thingAt(structure, 39)).toBe("channel:0");
  });
  it("tells a behaviour, an input and an output of one name apart", () => {
    const now = readStructure(
      "agents: { a: { control: { inputs: { x: bool }, outputs: { x: bool, y: bool }, behaviours: { x: {} } } } }",
    );
    const kindOf = (selection: string) => (findThing(now, selection)?.of as Buffer | undefined)?.yaml.at(-2);
    expect(["a.control.x", "input:a.control.x", "output:a.control.x"].map(kindOf)).toEqual(["behaviours", "inputs", "outputs"]);
    // As in an address that was written before buffers had a selection of their own.
    expect(kindOf("a.control.y")).toBe("outputs");
    expect(findThing(now, "real:a.control.x")).toBeUndefined();
    const [control] = now.agents[0]!.subsystems;
    expect(control!.buffers.map(({ selection }) => selection)).toEqual([
      "input:a.control.x",
      "output:a.control.x",
      "output:a.control.y",
    ]);
  });
  it("shows what there is of a broken file", () => {
    const broken = readStructure(example.replace("      outputs: { motion: Velocity }", "      outputs: { motion: Velocity"));
    expect(broken.agents.map((agent) => agent.name)).toContain("robot");
    expect(readStructure("").agents).toEqual([]);
    expect(readStructure("agents: [1").agents).toEqual([]);
  });
  it("finds the subsystems of a template behind its agents", () => {
    const fleet = readStructure(
      "templates: { t: { control: { rate: 1 Hz, behaviours: { a: {} } } }, u: { use: t } }\nagents: { robot: { use: u, count: 3 } }\n",
    );
    expect(findThing(fleet, "robot[2].control.a")).toMatchObject({
      kind: "behaviour",
      of: { yaml: ["templates", "t", "control", "behaviours", "a"] },
    });
  });
});

describe("edits of the server", () => {
  it("are applied at lines and letters, whatever ends the lines", () => {
    const place = (line: number, character: number) => ({ line, character });
    const edit = { from: place(1, 1), to: place(1, 3), text: "X" };
    expect(edits.applied("one\r\nä2ö4\r\n", [edit])).toBe("one\r\näX4\r\n");
    expect(edits.applied("one\ntwo4\n", [edit, { from: place(0, 0), to: place(0, 1), text: "" }])).toBe("ne\ntX4\n");
    expect(edits.applied("", [{ from: place(0, 0), to: place(0, 0), text: "a" }])).toBe("a");
  });
  it("have the new names of what was renamed before them", () => {
    const after = (renamed: Edit, edit: Edit) => edits.moved(edit, (at) => edits.pathAfter(renamed, at));
    const at = ["agents", "a", "control", "outputs"];
    const renamed = edits.rename([...at, "output"], "motion");
    expect(after(renamed, edits.set(at, "output", "bool"))).toEqual(edits.set(at, "motion", "bool"));
    expect(after(renamed, edits.remove([...at, "output"]))).toEqual(edits.remove([...at, "motion"]));
    expect(after(renamed, edits.set(at, "other", "bool"))).toEqual(edits.set(at, "other", "bool"));
    expect(after(renamed, edits.insert(at, "output", "bool"))).toEqual(edits.insert(at, "output", "bool"));
    expect(after(edits.rename(["agents", "a"], "b"), edits.set(at, "x", "1")).at![1]).toBe("b");
  });
  it("name what they change by its path", () => {
    expect(edits.addBuffer(subsystem(structure, "robot.sensor"), "real", "extra", "bool")).toEqual({
      do: "insert",
      at: ["agents", "robot", "receptors", "sensor", "real"],
      key: "extra",
      value: "bool",
    });
    expect(edits.changeNext(behaviour(structure, "robot.control.init"), 1, { when: "" })).toEqual({
      do: "next",
      at: ["agents", "robot", "control", "behaviours", "init"],
      key: "1",
      fields: { when: "" },
    });
  });
});

describe("names", () => {
  it("are those of C++", () => {
    expect(["follow", "a1", "a_b"].every(edits.isName)).toBe(true);
    expect(["", "1a", "a__b", "a_", "a b", "ä"].some(edits.isName)).toBe(false);
    expect(edits.freeName("run", ["run", "run_2"])).toBe("run_3");
  });
});
