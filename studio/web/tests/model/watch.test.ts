import { describe, expect, it } from "vitest";
import type { SubsystemAtEnd, Verdict } from "../../model/protocol";
import { stepsOf, stuck } from "../../live/verifier";
import { flagsOf } from "../../model/flags";
import { niceStep, stepFor } from "../../panels/plots/draw_timeline";
import { Series, shown } from "../../model/run/series";
import { plainColour } from "../../canvas/picture";
import { differences, Timeline } from "../../model/run/timeline";
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
  at_end: [],
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
    const waiting = (path: string): SubsystemAtEnd => ({
      path,
      state: "waits",
      awaited: "value",
      behaviour: "",
      channel: "x",
      from: ["b"],
      text: "",
    });
    const at_end = [waiting("a.control"), waiting("b")];
    const verdicts = [
      verdictOf({ at_end }),
      verdictOf({ at_end: at_end.slice(0, 1) }),
      verdictOf({ verdict: "holds", at_end: [waiting("c")] }),
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

describe("stepFor", () => {
  it("leaves room for each number of a time axis, however narrow it is", () => {
    for (const pixels of [60, 100, 108, 180, 240, 600])
      for (const seconds of [0.5, 1, 3, 10, 60, 600]) {
        const between = (stepFor(seconds, pixels, 6) / seconds) * pixels;
        expect(between, `${seconds} s on ${pixels} px`).toBeGreaterThanOrEqual(44);
      }
    expect(stepFor(10, 600, 6)).toBe(2);
  });
});
