import { describe, expect, it } from "vitest";
import { memoryOf } from "../../model/run/memory";
import { Series, shown } from "../../model/run/series";
import { readStructure } from "../../model/structure/structure";
import { unitOf } from "../../model/text/units";

const structure = readStructure(`
system: s
types: { Pose: { x: float64 m, heading: float64 rad } }
agents:
  robot:
    use: rover
    count: 12
  gate:
    control:
      inputs: { memory: Pose }
      behaviours: { watch: {} }
templates:
  rover:
    control:
      memory:
        free: float64 m
        at:   { type: Pose, initial: { x: 1 } }
        tried: "float64[2] rad/s"
        count: { type: uint32 }
      behaviours: { drive: {} }
`);

describe("memoryOf", () => {
  const series = new Series();
  series.add(0, "robot[10].control.memory.count", 1);
  series.add(0, "robot[2].control.memory.count", 7);
  series.add(0, "robot[2].control.memory.at", { x: 0.25, heading: 3 });
  series.add(0, "robot[2].control.motion", { linear: 1 });
  series.add(0, "robot[2].motor.memory.count", 5);
  series.add(0, "gate.control.memory", { x: 1, heading: 0 });
  it("is that of one member of a fleet", () => {
    expect(memoryOf(series.paths, "robot[2].control").map(({ label }) => label)).toEqual(["at.heading", "at.x", "count"]);
  });
  it("is that of all members, in their order, where the fleet is drawn once", () => {
    expect(memoryOf(series.paths, "robot.control").map(({ label }) => label)).toEqual([
      "robot[2]: at.heading",
      "robot[2]: at.x",
      "robot[2]: count",
      "robot[10]: count",
    ]);
  });
  it("is nothing where nothing is remembered", () => {
    expect(memoryOf(series.paths, "")).toEqual([]);
    expect(memoryOf(series.paths, "robot")).toEqual([]);
    expect(memoryOf(series.paths, "robot.drive")).toEqual([]);
  });
  it("changes with the time that is shown", () => {
    series.add(5, "robot[2].control.memory.count", 8);
    const { path } = memoryOf(series.paths, "robot[2].control")[2]!;
    expect([0, 4, 5].map((time) => shown(series.at(path, time)))).toEqual(["7", "7", "8"]);
  });
});

describe("unitOf memory", () => {
  it("is that of its field", () => {
    expect(unitOf(structure, "robot[3].control.memory.free")).toBe("m");
    expect(unitOf(structure, "robot[3].control.memory.at.heading")).toBe("rad");
    expect(unitOf(structure, "robot.control.memory.tried[1]")).toBe("rad/s");
    expect(unitOf(structure, "robot.control.memory.count")).toBe("");
    expect(unitOf(structure, "robot.control.memory.gone")).toBe("");
    expect(unitOf(structure, "robot.control.memory")).toBe("");
  });
  it("is not mixed up with a buffer of that name", () => {
    expect(unitOf(structure, "gate.control.memory.x")).toBe("m");
  });
});
