import { describe, expect, it } from "vitest";
import * as edits from "../../model/text/edits";
import { findThing, readStructure, thingAt, type Buffer, type Subsystem } from "../../model/structure/structure";
import { scalarText } from "../../model/text/yaml_text";
import { changes } from "./changes";
import { behaviour, buffer, example, structure, subsystem } from "./edited_example";

const changed = (after: string) => changes(example, after);

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

describe("adding changes only the lines it must", () => {
  it("adds a behaviour to a block", () => {
    expect(changed(edits.addBehaviour(structure, subsystem(structure, "robot.control"), "stop"))).toEqual(["+        stop: {}"]);
  });
  it("adds a behaviour to a map in one line, before the comment", () => {
    expect(changed(edits.addBehaviour(structure, subsystem(structure, "robot.sensor"), "rest"))).toEqual([
      "-        behaviours: { watch: {} }",
      "+        behaviours: { watch: {}, rest: {} }",
    ]);
  });
  it("adds an agent, a receptor and an effector", () => {
    expect(changed(edits.addAgent(structure, "other"))).toEqual([
      "+  other:",
      "+    control:",
      "+      rate: 10 Hz",
      "+      behaviours:",
      "+        run: {}",
    ]);
    const receptor = edits.addSubsystem(structure, structure.agents[0]!, "receptor", "bumper");
    expect(changed(receptor)).toEqual(["+      bumper:", "+        rate: 50 Hz", "+        behaviours:", "+          run: {}"]);
  });
  it("makes the section that was not there", () => {
    const text = "tessera: 1\nagents:\n  a:\n    control:\n      behaviours: { run: {} }\n";
    const after = edits.addBuffer(readStructure(text), subsystem(readStructure(text), "a.control"), "input", "x", "float64[3] m");
    expect(changes(text, after)).toEqual(["+      inputs:", '+        x: "float64[3] m"']);
    const channel = edits.addChannel(readStructure(after), "b.control.y", "a.control.x", {
      send: "non_blocking",
      receive: "non_blocking",
      timeout: "",
    });
    expect(readStructure(channel).channels[0]).toMatchObject({ from: "b.control.y", to: "a.control.x" });
  });
  it("adds a channel in the short form, or with its modes", () => {
    const ends = ["robot.control.motion", "robot.motor.more"] as const;
    expect(changed(edits.addChannel(structure, ...ends, { send: "non_blocking", receive: "non_blocking", timeout: "" }))).toEqual(
      ["+  - robot.control.motion -> robot.motor.more"],
    );
    expect(changed(edits.addChannel(structure, ...ends, { send: "blocking", receive: "non_blocking", timeout: "1 s" }))).toEqual([
      "+  - { from: robot.control.motion, to: robot.motor.more, send: blocking, timeout: 1 s }",
    ]);
  });
});

describe("changing", () => {
  const control = subsystem(structure, "robot.control");
  it("keeps spaces and comments around a value", () => {
    expect(changed(edits.setField(structure, subsystem(structure, "robot.motor").yaml, "stale", "1 s"))).toEqual([
      "-        stale:    500 ms                                              # no velocity for so long: safe",
      "+        stale:    1 s                                              # no velocity for so long: safe",
    ]);
    expect(changed(edits.setField(structure, control.yaml, "rate", "25 Hz"))).toEqual([
      "-      rate: 20 Hz",
      "+      rate: 25 Hz",
    ]);
  });
  it("quotes a condition only where YAML asks for it", () => {
    expect(scalarText("in.line.left")).toBe("in.line.left");
    expect(scalarText("true")).toBe("true");
    expect(scalarText("!in.order.go")).toBe('"!in.order.go"');
    expect(scalarText("{ a: memory.n > 2 }")).toBe("{ a: memory.n > 2 }");
    const after = edits.setField(structure, behaviour(structure, "robot.control.follow").yaml, "terminal", "in.line.left, or so");
    expect(readStructure(after).agents[0]!.subsystems[0]!.behaviours[1]!.terminal).toBe("in.line.left, or so");
  });
  it("takes a field away when it is emptied", () => {
    expect(changed(edits.setField(structure, control.yaml, "rate", ""))).toEqual(["-      rate: 20 Hz"]);
    expect(changed(edits.setField(structure, behaviour(structure, "robot.control.init").yaml, "terminal", ""))).toEqual([
      "-        init:   { terminal: true, next: follow }",
      "+        init:   { next: follow }",
    ]);
  });
  it("changes the modes of a channel, whichever form it has", () => {
    const [short, long] = structure.channels;
    expect(changed(edits.setChannel(structure, short!, { receive: "blocking" }))[1]).toContain(
      "{ from: robot.sensor.line, to: robot.control.line, receive: blocking }",
    );
    expect(changed(edits.setChannel(structure, short!, { receive: "blocking" }))[1]).toContain("# non-blocking at both ends");
    expect(changed(edits.setChannel(structure, long!, { receive: "non_blocking" }))[1]).toBe(
      "+  - { from: robot.control.motion, to: robot.motor.velocity, timeout: 200 ms }",
    );
    expect(changed(edits.setChannel(structure, long!, { send: "blocking" }))[1]).toContain("timeout: 200 ms, send: blocking }");
  });
  it("gives a channel in lines of its own a model, and keeps its comments", () => {
    const text = `channels:
  - from: a.control.x                  # measured
    to: b.control.y
    send: blocking                     # waits
    send_timeout: 1 s                  # not for long
`;
    const after = edits.setModel(readStructure(text), readStructure(text).channels[0]!, "queue");
    expect(changes(text, after)).toEqual(["-    send: blocking                     # waits", "+    model: queue"]);
    expect(edits.setModel(readStructure(after), readStructure(after).channels[0]!, "")).not.toContain("model");
    const short = readStructure("channels:\n  - a.control.x -> b.control.y   # measured\n");
    expect(edits.setModel(short, short.channels[0]!, "queue")).toBe(
      "channels:\n  - { from: a.control.x, to: b.control.y, model: queue }   # measured\n",
    );
  });
});

describe("removing", () => {
  it("takes the channels and drivers of a subsystem with it", () => {
    const after = readStructure(edits.removeSubsystem(structure, subsystem(structure, "robot.sensor"), readStructure));
    expect(after.agents[0]!.subsystems.map((one) => one.name)).toEqual(["control", "motor"]);
    expect(after.channels.map((one) => one.to)).toEqual(["robot.motor.velocity"]);
    expect(after.yaml.keys(["simulation", "drivers"])).toEqual(["robot.motor.left", "robot.motor.right"]);
    expect(after.yaml.pair(["agents", "robot", "receptors"])).toBeUndefined();
  });
  it("takes what leads to a behaviour with it", () => {
    const after = edits.removeBehaviour(
      structure,
      subsystem(structure, "robot.control"),
      behaviour(structure, "robot.control.follow"),
      readStructure,
    );
    expect(changed(after)).toEqual([
      "-        init:   { terminal: true, next: follow }",
      "-        follow: {}",
      "+        init:   { terminal: true }",
    ]);
  });
  it("removes the last channel with its section, and a buffer from the middle of a line", () => {
    expect(readStructure(edits.removeChannel(structure, structure.channels[0]!)).channels.length).toBe(1);
    const after = edits.removeBuffer(
      structure,
      subsystem(structure, "robot.sensor"),
      buffer(structure, "robot.sensor.middle"),
      readStructure,
    );
    expect(after).toContain("real:    { left: float64, right: float64 }   # reflected light");
  });
});

describe("removing what has the name of something else", () => {
  const text = `agents:
  a:
    control:
      inputs: { x: bool }
      outputs: { x: bool }
      behaviours: { x: {}, run: { next: { to: x, when: error } } }
    effectors:
      motor: { inputs: { speed: bool }, real: { speed: bool }, behaviours: { drive: {} } }
channels: [a.control.x -> a.motor.speed, b.control.z -> a.control.x]
drivers: { a.motor.speed: { cpp: Motor } }
deploy: { processes: { one: a, two: [a, b] } }
simulation: { models: { a: { model: a.xml } } }
`;
  const now = readStructure(text);
  const things = (after: string) => {
    const { channels, yaml } = readStructure(after);
    return [channels.map(({ from, to }) => `${from} ${to}`), yaml.keys(["drivers"])];
  };
  it("keeps the channels and drivers of other buffers", () => {
    const of = (selection: string) => findThing(now, selection) as { of: Buffer; subsystem: Subsystem };
    const without = (selection: string) =>
      things(edits.removeBuffer(now, of(selection).subsystem, of(selection).of, readStructure));
    expect(without("output:a.control.x")).toEqual([["b.control.z a.control.x"], ["a.motor.speed"]]);
    expect(without("input:a.control.x")).toEqual([["a.control.x a.motor.speed"], ["a.motor.speed"]]);
    expect(without("real:a.motor.speed")[0]).toHaveLength(2);
    expect(without("input:a.motor.speed")).toEqual([["b.control.z a.control.x"], ["a.motor.speed"]]);
  });
  it("takes a map of `next` that leads to a behaviour with it", () => {
    const after = edits.removeBehaviour(now, subsystem(now, "a.control"), behaviour(now, "a.control.x"), readStructure);
    expect(after).toContain("behaviours: { run: {} }");
  });
  it("takes an agent out of its processes and the world", () => {
    const after = readStructure(edits.removeAgent(now, now.agents[0]!, readStructure)).yaml;
    expect(after.valueText(["deploy", "processes"])).toBe("{ two: [b] }");
    expect(after.keys(["simulation", "models"])).toEqual([]);
    const alone = readStructure("agents: { a: {}, b: {} }\ndeploy:\n  processes:\n    one: [a]\n");
    expect(edits.removeAgent(alone, alone.agents[0]!, readStructure)).toBe("agents: { b: {} }\n");
  });
});

describe("names", () => {
  it("are those of C++", () => {
    expect(["follow", "a1", "a_b"].every(edits.isName)).toBe(true);
    expect(["", "1a", "a__b", "a_", "a b", "ä"].some(edits.isName)).toBe(false);
    expect(edits.freeName("run", ["run", "run_2"])).toBe("run_3");
  });
});
