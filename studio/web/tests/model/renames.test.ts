import { describe, expect, it } from "vitest";
import * as renames from "../../model/text/renames";
import { findThing, readStructure, type Buffer, type Subsystem } from "../../model/structure/structure";
import { changes } from "./changes";
import { behaviour, buffer, example, structure, subsystem } from "./edited_example";

const changed = (after: string) => changes(example, after);

describe("renaming changes the name wherever it stands, and nothing else", () => {
  it("renames an agent", () => {
    const after = renames.renameAgent(structure, structure.agents[0]!, "rover");
    // Two changes: the comment in the first line, and the body of the world that the check and the measures
    // name.
    expect(after.match(/\brobot\b/g)).toHaveLength(4);
    expect(changed(after).length).toBe(2 * 9);
    expect(changed(after)).toContain(
      "+  - rover.sensor.line -> rover.control.line                           # non-blocking at both ends",
    );
  });
  it("renames a subsystem in channels, drivers and properties", () => {
    const after = renames.renameSubsystem(structure, subsystem(structure, "robot.motor"), "wheels");
    expect(changed(after).filter((line) => line.startsWith("+")).length).toBe(5);
    expect(after).toContain("robot.wheels.drive");
    expect(after).toContain("robot.wheels.left:");
  });
  it("renames a behaviour where it follows another", () => {
    const after = renames.renameBehaviour(
      structure,
      subsystem(structure, "robot.control"),
      behaviour(structure, "robot.control.follow"),
      "trail",
    );
    expect(changed(after)).toEqual([
      "-        init:   { terminal: true, next: follow }",
      "-        follow: {}",
      "+        init:   { terminal: true, next: trail }",
      "+        trail: {}",
    ]);
  });
  it("renames a buffer in conditions, lists and channels", () => {
    const text = example.replace(
      "follow: {}",
      'follow: { terminal: "in.line.left && in.liner", receive: [line], send: [motion] }',
    );
    const now = readStructure(text);
    const after = renames.renameBuffer(now, subsystem(now, "robot.control"), buffer(now, "robot.control.line"), "seen");
    expect(after).toContain('{ terminal: "in.seen.left && in.liner", receive: [seen], send: [motion] }');
    expect(after).toContain("robot.sensor.line -> robot.control.seen");
  });
  it("renames the real buffer of an effector with its safe value and driver", () => {
    const after = renames.renameBuffer(
      structure,
      subsystem(structure, "robot.motor"),
      buffer(structure, "robot.motor.left"),
      "port",
    );
    expect(changed(after).filter((line) => line.startsWith("+"))).toEqual([
      "+        real:     { port: float64 rad/s, right: float64 rad/s }",
      "+        safe:     { port: 0, right: 0 }",
      "+    robot.motor.port:    { velocity: wheel_left }",
    ]);
  });
});

describe("a name that several elements have", () => {
  const text = `agents:
  a:
    control:
      inputs: { x: bool }
      outputs: { x: bool }
      behaviours:
        x: { send: [x], receive: x, terminal: in.x, next: [{ to: x, when: "in.x && !out.x" }, run] }
        run: { next: { to: x, when: error } }
    receptors:
      eye: { real: { x: bool }, outputs: { x: bool }, behaviours: { look: { terminal: in.x || out.x, send: [x] } } }
channels:
  - a.eye.x -> a.control.x
  - { from: a.control.x, to: b.control.x }
drivers: { a.eye.x: { cpp: Eye } }
properties:
  - { name: a.control.x runs, reachable: a.control.x }
  - { reachable: "a.control.x or a.control.x -> b.control.x.full" }
`;
  const now = readStructure(text);
  const renamed = (selection: string) => {
    const thing = findThing(now, selection) as {
      kind: string;
      of: Buffer & Subsystem["behaviours"][number];
      subsystem: Subsystem;
    };
    const of = thing.kind === "behaviour" ? renames.renameBehaviour : renames.renameBuffer;
    return changes(text, of(now, thing.subsystem, thing.of, "new")).filter((line) => line.startsWith("+"));
  };
  it("is the name of a behaviour in `next` and properties", () => {
    expect(renamed("a.control.x")).toEqual([
      '+        new: { send: [x], receive: x, terminal: in.x, next: [{ to: new, when: "in.x && !out.x" }, run] }',
      "+        run: { next: { to: new, when: error } }",
      "+  - { name: a.control.x runs, reachable: a.control.new }",
      '+  - { reachable: "a.control.new or a.control.x -> b.control.x.full" }',
    ]);
  });
  it("is the name of an input at the end of a channel", () => {
    expect(renamed("input:a.control.x")).toEqual([
      "+      inputs: { new: bool }",
      '+        x: { send: [x], receive: new, terminal: in.new, next: [{ to: x, when: "in.new && !out.x" }, run] }',
      "+  - a.eye.x -> a.control.new",
    ]);
  });
  it("is the name of an output at the beginning of a channel", () => {
    expect(renamed("output:a.control.x")).toEqual([
      "+      outputs: { new: bool }",
      '+        x: { send: [new], receive: x, terminal: in.x, next: [{ to: x, when: "in.x && !out.new" }, run] }',
      "+  - { from: a.control.new, to: b.control.x }",
      '+  - { reachable: "a.control.x or a.control.new -> b.control.x.full" }',
    ]);
  });
  it("is the name of a real buffer in drivers, and of what a receptor reads", () => {
    expect(renamed("real:a.eye.x")).toEqual([
      "+      eye: { real: { new: bool }, outputs: { x: bool }, behaviours: { look: { terminal: in.new || out.x, send: [x] } } }",
      "+drivers: { a.eye.new: { cpp: Eye } }",
    ]);
  });
});

it("a buffer may be named in a property, if no behaviour has its name", () => {
  const text = `agents: { a: { control: { inputs: { x: bool, y: bool }, behaviours: { x: {} } } } }
properties: [{ reachable: a.control.x.rcv and a.control.y.full }]
`;
  const now = readStructure(text);
  const renamed = (path: string) =>
    renames.renameBuffer(now, subsystem(now, "a.control"), buffer(now, path), "new").split("reachable: ")[1];
  expect(renamed("input:a.control.x")).toBe("a.control.x.rcv and a.control.y.full }]\n");
  expect(renamed("input:a.control.y")).toBe("a.control.x.rcv and a.control.new.full }]\n");
});

describe("the name of an agent", () => {
  const text = `agents:
  arm: { control: { behaviours: { run: {} } } }
  m: { use: rover, count: 2 }
  lone: { use: rover }
deploy:
  processes:
    arm: arm
    m[*]: { agents: ["m[*]"], host: m }
    rest: [lone, "m[1]"]
simulation:
  models:
    arm: { model: arm.xml, at: [0, 0] }
    m[*]: { model: m.xml, vary: { m.mass: [1, 2] } }
  drivers:
    m[*].base.command: { actuator: m }
    arm.hand.grip: { weld: "m[1]/hook", with: [/m/hook, arm/palm] }
    m[1].own.bus: { cpp: Bus, file: m/bus }
  checks:
    - { name: m stands, never: "speed(m[0]) > 3 m/s and contact(arm/palm, m[i+1])" }
  measures: { m: "distance(m[*], arm) + 2 m", arm: height(arm/m) }
properties:
  - { always: "all(m[*].control.run) or lone.control.run" }
`;
  const now = readStructure(text);
  const renamed = (name: string) => {
    const after = renames.renameAgent(
      now,
      now.agents.find((one) => one.name === name)!,
      "new",
    );
    return changes(text, after).filter((line) => line.startsWith("+"));
  };
  it("follows in processes, placed models, drivers, checks, measures and properties", () => {
    expect(renamed("m")).toEqual([
      "+  new: { use: rover, count: 2 }",
      '+    m[*]: { agents: ["new[*]"], host: m }',
      '+    rest: [lone, "new[1]"]',
      "+    new[*]: { model: m.xml, vary: { m.mass: [1, 2] } }",
      "+    new[*].base.command: { actuator: m }",
      '+    arm.hand.grip: { weld: "new[1]/hook", with: [/m/hook, arm/palm] }',
      "+    new[1].own.bus: { cpp: Bus, file: m/bus }",
      '+    - { name: m stands, never: "speed(new[0]) > 3 m/s and contact(arm/palm, new[i+1])" }',
      '+  measures: { m: "distance(new[*], arm) + 2 m", arm: height(arm/m) }',
      '+  - { always: "all(new[*].control.run) or lone.control.run" }',
    ]);
    expect(renamed("arm")).toEqual([
      "+  new: { control: { behaviours: { run: {} } } }",
      "+    arm: new",
      "+    new: { model: arm.xml, at: [0, 0] }",
      '+    new.hand.grip: { weld: "m[1]/hook", with: [/m/hook, new/palm] }',
      '+    - { name: m stands, never: "speed(m[0]) > 3 m/s and contact(new/palm, m[i+1])" }',
      '+  measures: { m: "distance(m[*], new) + 2 m", arm: height(new/m) }',
    ]);
  });
  it("of a placed model alone follows in checks and measures", () => {
    const after = renames.renamePlaced(text, "m[*]", "crate[*]");
    expect(after).toContain('never: "speed(crate[0]) > 3 m/s');
    expect(after).toContain("\n    crate[*]: { model: m.xml");
    expect(after).toContain("\n  m: { use: rover, count: 2 }");
  });
});

describe("names of a subsystem's memory and parameters", () => {
  it("follow in its conditions", () => {
    const text =
      "agents: { a: { control: { memory: { n: int32 }, behaviours: { run: { terminal: memory.n > in.memory.n } } } } }\n";
    const now = readStructure(text);
    const after = renames.renameCell(now, subsystem(now, "a.control"), "memory", "n", "count");
    expect(after).toBe(text.replace("{ n: int32", "{ count: int32").replace("memory.n >", "memory.count >"));
  });
});
