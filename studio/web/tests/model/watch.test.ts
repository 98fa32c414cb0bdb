import { describe, expect, it } from "vitest";
import type { Verdict } from "../../live/protocol";
import { stepsOf, stuck } from "../../live/verifier";
import { flagsOf } from "../../model/flags";
import { niceStep } from "../../panels/draw_timeline";
import { Series, shown } from "../../model/series";
import { plainColour } from "../../canvas/picture";
import { channelLabels } from "../../model/channel_labels";
import { chipLines, lanes, layoutStructure } from "../../model/structure_layout";
import { readStructure } from "../../model/structure";
import { differences, Timeline } from "../../model/timeline";
import { intersects } from "../../model/geometry";
import { lineFollower } from "./line_follower";

const net = lineFollower();
const named = (name: string) => net.transitionByName.get(name)!;

describe("Timeline", () => {
  it("says which behaviour ran from when", () => {
    const timeline = new Timeline(net);
    const run = [
      "robot.control.t_in",
      "robot.control.init.t1",
      "robot.control.t_init_1",
      "robot.control.follow.t1",
      "robot.control.t_follow_1",
    ];
    run.forEach((name, at) => timeline.add(at * 10, named(name)));
    const [control] = timeline.lanes;
    expect(control!.segments).toEqual([
      { start: 0, behaviour: "init" },
      { start: 20, behaviour: "follow" },
      { start: 40, behaviour: "" },
    ]);
    expect(control!.firings).toEqual([0, 10, 20, 30, 40]);
    expect(timeline.lanes[1]!.firings).toEqual([]);
  });
  it("finds the first firing of a span", () => {
    expect(Timeline.from([1, 3, 3, 7], 3)).toBe(1);
    expect(Timeline.from([1, 3, 3, 7], 8)).toBe(4);
  });
  it("keeps a bounded part of an endless run", () => {
    const timeline = new Timeline(net);
    for (let at = 0; at < 50_000; at += 1) timeline.add(at, named("robot.control.follow.t1"));
    expect(timeline.lanes[0]!.firings.length).toBeLessThanOrEqual(20_000);
    expect(timeline.lanes[0]!.firings.at(-1)).toBe(49_999);
  });
});

describe("differences", () => {
  const after = (...run: string[]) => {
    const timeline = new Timeline(net);
    run.forEach((name, at) => timeline.add(at * 10, named(name)));
    return timeline;
  };
  const toFollow = after("robot.control.t_in", "robot.control.init.t1", "robot.control.t_init_1", "robot.control.follow.t1");
  const inInit = after("robot.control.t_in", "robot.control.init.t1");
  it("names the subsystems that do something else at a moment", () => {
    expect(differences(toFollow, inInit, 25)).toEqual([{ path: "robot.control", behaviours: ["follow", "init"] }]);
    expect(differences(toFollow, inInit, 15)).toEqual([]);
    expect(differences(toFollow, inInit, -1)).toEqual([]);
  });
  it("takes what runs from markings too, where firings are missing", () => {
    const sampled = after("robot.control.t_in");
    sampled.tell(21, new Map([[sampled.lanes[0]!.subsystem, "follow"]]));
    expect(differences(toFollow, sampled, 25)).toEqual([]);
    expect(Timeline.behaviourAt(sampled.lanes[0]!, 20)).toBe("init");
  });
  it("says nothing of what is forgotten", () => {
    const long = new Timeline(net, 4);
    for (let at = 0; at < 8; at += 1) long.add(at, named(at % 2 ? "robot.control.t_init_1" : "robot.control.t_in"));
    expect(Timeline.behaviourAt(long.lanes[0]!, 0)).toBeUndefined();
    expect(Timeline.behaviourAt(long.lanes[0]!, 7)).toBe("follow");
  });
});

describe("Series", () => {
  it("takes structures, arrays and numbers apart", () => {
    const series = new Series();
    series.add(5, "a", { left: true, ranges: [1, 2], name: "x", big: new Array(40).fill(0) });
    expect(series.paths.map((path) => [path, series.at(path, 5)])).toEqual([
      ["a.big", "40 values"],
      ["a.left", true],
      ["a.name", "x"],
      ["a.ranges[0]", 1],
      ["a.ranges[1]", 2],
    ]);
    expect(series.samples.get("a.left")).toEqual({ times: [5], values: [1] });
    expect(series.samples.has("a.name")).toBe(false);
  });
  it("says what a value was at a moment, and holds what is not told anew", () => {
    const series = new Series();
    series.add(5, "a", { left: true, name: "x" });
    series.add(9, "b", 3);
    series.add(12, "a", { left: false, name: "y" });
    expect(["a.left", "a.name", "b"].map((path) => series.at(path, 11))).toEqual([true, "x", 3]);
    expect(series.at("a.name", 12)).toBe("y");
    expect(series.at("b", 8)).toBeUndefined();
  });
  it("forgets nothing of what has an end", () => {
    const [run, recording] = [new Series(), new Series(Infinity)];
    for (const series of [run, recording]) for (let at = 0; at < 9000; at += 1) series.add(at, "a", at);
    expect(run.at("a", 10)).toBeUndefined();
    expect(recording.at("a", 10)).toBe(10);
  });
  it("shows numbers short", () => {
    expect([0.2, 3, 1234567.5, 0.00001, true].map(shown)).toEqual(["0.2000", "3", "1.23e+6", "1.00e-5", "true"]);
  });
});

describe("niceStep", () => {
  it("is 1, 2 or 5 times a power of ten", () => {
    expect([0.3, 1.2, 4, 70].map(niceStep)).toEqual([0.5, 2, 5, 100]);
  });
});

describe("flagsOf", () => {
  it("marks the innermost page that begins on the line, errors before warnings", () => {
    const flags = flagsOf(net, [
      { severity: "warning", line: 19 },
      { severity: "error", line: 19 },
      { severity: "warning", line: 22 },
      { severity: "hint", line: 13 },
    ]);
    expect([...flags]).toEqual([
      ["robot.control.follow", "error"],
      ["robot.sensor", "warning"],
    ]);
  });
});

const verdictOf = (known: Partial<Verdict>): Verdict => ({
  name: "x",
  asks: "",
  verdict: "violated",
  method: "search",
  why: "",
  meaning: "",
  explanation: "",
  seconds: 0,
  states: 0,
  warning: false,
  waits: [],
  behaviours: [],
  trace: null,
  steps: null,
  narrative: null,
  ...known,
});

describe("stepsOf", () => {
  it("leaves out the step that stands for no net's transition", () => {
    expect(stepsOf(verdictOf({ steps: [0, 2, net.transitions.length] }), net)).toEqual([0, 2]);
  });
  it("has none of a verdict without a run", () => {
    expect(stepsOf(verdictOf({}), net)).toBeNull();
    expect(stepsOf(verdictOf({ steps: [] }), net)).toBeNull();
  });
});

describe("stuck", () => {
  it("names who waits in a violation, once", () => {
    const waits = ["a.control waits for the acknowledgement of x from b", "b waits for y"];
    const verdicts = [
      verdictOf({ waits }),
      verdictOf({ waits: waits.slice(0, 1) }),
      verdictOf({ verdict: "holds", waits: ["c waits for z"] }),
    ];
    expect(stuck(verdicts)).toEqual(["a.control", "b"]);
  });
});

describe("plainColour", () => {
  it("says mixed colours in the words of SVG, and leaves others alone", () => {
    expect(plainColour("color(srgb 1 0.5 0)")).toBe("rgb(255, 128, 0)");
    expect(plainColour("color(srgb 1 0.5 0 / 0.25)")).toBe("rgba(255, 128, 0, 0.25)");
    expect(plainColour("rgb(1, 2, 3)")).toBe("rgb(1, 2, 3)");
  });
});

describe("layoutStructure", () => {
  const text = (behaviours: string) =>
    `agents:\n  a:\n    control: { inputs: { i: bool }, behaviours: { ${behaviours} } }\n    receptors:\n      r: { real: { x: bool }, outputs: { o: bool }, behaviours: { w: {} } }\n      s: { outputs: { o: bool }, behaviours: { w: {} } }\n    effectors: { e: { inputs: { m: bool }, behaviours: { d: {} } } }\n  b: { control: { behaviours: { run: {} } } }\n`;
  it("puts nothing over anything else", () => {
    const agents = layoutStructure(
      readStructure(text("one: {}, two: {}, three: {}, a_rather_long_name: {}, another_long_name: {}")),
    );
    const boxes = agents.flatMap((agent) => [...agent.subsystems, ...agent.devices]);
    expect(boxes.length).toBe(6);
    boxes.forEach((one, at) => boxes.slice(at + 1).forEach((other) => expect(intersects(one, other)).toBe(false)));
    for (const agent of agents)
      for (const one of [...agent.subsystems, ...agent.devices])
        expect(
          one.x >= agent.x && one.x + one.width <= agent.x + agent.width && one.y + one.height <= agent.y + agent.height,
        ).toBe(true);
    expect(intersects(agents[0]!, agents[1]!)).toBe(false);
  });
  it("leaves a channel with a long name a piece of line at either end", () => {
    const between = (channel: string) => {
      const [agent] = layoutStructure(
        readStructure(`${text("one: {}")}channels:\n  - { from: a.r.o, to: a.control.i${channel} }\n`),
      );
      const at = (path: string) => agent!.subsystems.find((one) => one.path === path)!;
      return at("a.control").x - at("a.r").x - at("a.r").width;
    };
    const name = "a_communication_model_of_its_own";
    expect(between(`, model: ${name}`)).toBeGreaterThan(name.length * 6 + 40);
    expect(between(`, model: ${name}`)).toBeGreaterThan(between(""));
  });
  it("sets the labels of channels that meet beside each other", () => {
    const meeting = readStructure(
      "agents:\n  a: { receptors: { r: { outputs: { o: bool } } }, control: { inputs: { i: bool, h: bool }, outputs: { s: bool } }, effectors: { e: {} } }\n" +
        "  b: { control: { inputs: { s: bool }, outputs: { t: bool } } }\n" +
        "channels:\n  - b.control.t -> a.control.i\n  - a.control.s -> b.control.s\n  - a.r.o -> a.control.h\n",
    );
    const boxes = layoutStructure(meeting);
    const places = [...channelLabels(meeting, boxes, lanes(meeting, boxes)).values()];
    expect(places.length).toBe(3);
    places.forEach((one, at) =>
      places
        .slice(at + 1)
        .forEach((other) => expect(Math.abs(one.x - other.x) > 50 || Math.abs(one.y - other.y) >= 20).toBe(true)),
    );
  });
  it("makes room for many behaviours", () => {
    const control = (behaviours: string) => readStructure(text(behaviours)).agents[0]!.subsystems[0]!;
    expect(chipLines(control("one: {}"))).toBe(1);
    expect(chipLines(control("a_rather_long_name: {}, another_long_name: {}, one: {}"))).toBeGreaterThan(1);
  });
  it("leads channels that go back below the boxes of their agent, each in its own lane", () => {
    const back = readStructure(
      text("one: {}") +
        "channels:\n  - a.e.m -> a.control.i\n  - { from: a.control.o, to: a.control.i }\n  - { from: a.control.o, to: a.s.x }\n",
    );
    const agents = layoutStructure(back);
    const heights = [...lanes(back, agents).values()];
    const lowest = Math.max(...[...agents[0]!.subsystems, ...agents[0]!.devices].map((one) => one.y + one.height));
    expect(new Set(heights).size).toBe(3);
    for (const height of heights) {
      expect(height).toBeGreaterThan(lowest);
      expect(height).toBeLessThan(agents[0]!.y + agents[0]!.height);
    }
  });
});
