import { describe, expect, it } from "vitest";
import type { ParameterShown, RecordingInfo, SweepRow } from "../../../model/protocol";
import { firstDifference, type ComparedRun } from "../../../model/run/first_difference";
import { recordingsWith } from "../../../model/run/recording_search";
import { Series } from "../../../model/run/series";
import {
  distributionOf,
  measuresOf,
  numberWithUnit,
  sweptParameters,
  sweptPoints,
  sweptValues,
  type SweepTyped,
} from "../../../model/run/sweep";

const parameter = (path: string, more: Partial<ParameterShown> = {}): ParameterShown => ({
  path,
  type: "float64",
  unit: "m/s",
  minimum: 0,
  maximum: 1,
  initial: "0.2",
  value: null,
  differs: false,
  ...more,
});
const typed: SweepTyped = { parameter: "v", from: "0.1", to: "0.4 m/s", steps: "4", runs: "2", seed: "1", duration: "5s" };

describe("sweptValues", () => {
  it("lie evenly between both ends, with their unit", () => {
    expect(sweptValues(typed, parameter("v"))).toEqual({ values: ["0.1 m/s", "0.2 m/s", "0.3 m/s", "0.4 m/s"], mistakes: {} });
    const whole = parameter("n", { type: "uint8", unit: "", maximum: null });
    expect(sweptValues({ ...typed, from: "3", to: "1", steps: "5" }, whole).values).toEqual(["3", "2", "1"]);
  });
  it("are refused where they are typed: no number, another unit, out of range, too many", () => {
    const wrong = (more: Partial<SweepTyped>) => sweptValues({ ...typed, ...more }, parameter("v")).mistakes;
    expect(wrong({ from: "fast" })).toEqual({ from: "a number in m/s" });
    expect(wrong({ from: "0.1 m" })).toEqual({ from: "a number in m/s" });
    expect(wrong({ from: "-1", to: "1.5" })).toEqual({ from: "at least 0 m/s", to: "at most 1 m/s" });
    expect(wrong({ to: "0.1" })).toEqual({ to: "another number than the first one" });
    expect(wrong({ steps: "1" })).toEqual({ steps: "a whole number from 2 to 200" });
    expect(wrong({ steps: "200", runs: "51" })).toEqual({ runs: "200 values × 51 runs are more than 10,000" });
    expect(wrong({ seed: "-1", duration: "soon" })).toEqual({
      seed: "a whole number from 0 to 9000000000000000",
      duration: "a time such as 10s or 2min",
    });
    expect(sweptValues(typed, undefined).mistakes).toEqual({ parameter: "there is no such parameter" });
  });
  it("need no parameter if only the seeds differ", () => {
    expect(sweptValues({ ...typed, parameter: "", from: "", to: "" }, undefined)).toEqual({ values: [], mistakes: {} });
  });
  it("reads numbers as people write them", () => {
    expect([" 5e-2", "+.5 m/s", "3", "", "m/s", "1,5"].map((text) => numberWithUnit(text, "m/s"))).toEqual([
      0.05,
      0.5,
      3,
      NaN,
      NaN,
      NaN,
    ]);
  });
});

describe("sweptParameters", () => {
  it("are numbers; those of the members of a fleet are one", () => {
    const all = [
      parameter("v"),
      parameter("robot[0].control.w"),
      parameter("robot[1].control.w"),
      parameter("robot[0].extra.k"),
      parameter("name", { type: "string" }),
      parameter("on", { type: "bool" }),
      parameter("points", { type: "float64[3]" }),
    ];
    expect(sweptParameters(all).map(({ path }) => path)).toEqual(["v", "robot[*].control.w", "robot[0].extra.k"]);
  });
});

describe("the results of a sweep", () => {
  const row = (value: string, seed: number, error: number | null, failed = false): SweepRow => ({
    value,
    seed,
    failed,
    ended: failed ? "deadlock" : "duration",
    numbers: { error, failed: failed ? 1 : 0 },
    units: { error: "m" },
  });
  const rows = [row("10 m/s", 1, 4), row("2 m/s", 1, 1), row("2 m/s", 2, 3), row("10 m/s", 2, null, true)];
  it("are a point for each value, in the order of the numbers", () => {
    expect(sweptPoints(rows, "error")).toEqual([
      { value: "2 m/s", x: 2, runs: 2, failed: 0, numbers: { min: 1, mean: 2, max: 3, std: Math.SQRT2, count: 2 } },
      { value: "10 m/s", x: 10, runs: 2, failed: 1, numbers: { min: 4, mean: 4, max: 4, std: 0, count: 1 } },
    ]);
    expect(measuresOf(rows)).toEqual(["error", "failed"]);
  });
  it("are counted in ranges, and none is lost at the edge", () => {
    const bins = distributionOf(rows, "error");
    expect(bins.reduce((sum, { runs }) => sum + runs, 0)).toBe(3);
    expect([bins[0]!.from, bins.at(-1)!.to]).toEqual([1, 4]);
    expect(distributionOf(rows.slice(0, 1), "error")).toEqual([{ from: 4, to: 4, runs: 1 }]);
    expect(distributionOf(rows, "nothing")).toEqual([]);
  });
});

describe("firstDifference", () => {
  const run = (values: [number, string, unknown][], end = 100, calls: number[] = []): ComparedRun => {
    const series = new Series();
    for (const [time, path, value] of values) series.add(time, path, value);
    const lane = { path: "robot.control", subsystem: 0, segments: [], firings: [], calls, behaviours: [], since: -Infinity };
    return { series, timeline: { lanes: [lane] }, end };
  };
  const battery = "robot.control.memory.battery";
  it("names the value, the time, both values, and the iteration", () => {
    const one = run(
      [
        [1, battery, 0.9],
        [5, battery, 0.71],
        [6, "robot.control.x", 1],
      ],
      100,
      [0, 2, 5, 9],
    );
    const other = run([
      [1, battery, 0.9],
      [5, battery, 0.69],
      [6, "robot.control.x", 2],
    ]);
    expect(firstDifference(one, other)).toEqual({
      path: battery,
      time: 5,
      values: [0.71, 0.69],
      subsystem: "robot.control",
      iteration: 3,
    });
  });
  it("finds a change that only one of them has", () => {
    const one = run([
      [1, battery, 1],
      [3, battery, 2],
      [4, battery, 3],
    ]);
    const other = run([
      [1, battery, 1],
      [4, battery, 3],
    ]);
    expect(firstDifference(one, other)).toMatchObject({ time: 3, values: [2, 1] });
    expect(firstDifference(run([[2, "a", "x"]]), run([]))).toMatchObject({ path: "a", values: ["x", undefined] });
  });
  it("does not count values that were only written again, nor what one of them has not reached", () => {
    expect(
      firstDifference(
        run([
          [1, "a", 1],
          [2, "a", 1],
        ]),
        run([[1, "a", 1]]),
      ),
    ).toBeNull();
    expect(
      firstDifference(
        run([
          [1, "a", 0],
          [50, "a", 7],
        ]),
        run([[1, "a", -0]], 40),
      ),
    ).toBeNull();
  });
  it("allows runs in real time to be a little apart", () => {
    const one = run([
      [10, "a", 1],
      [20, "a", 2],
    ]);
    const other = run([
      [12, "a", 1],
      [23, "a", 2],
    ]);
    expect(firstDifference(one, other, 5)).toBeNull();
    expect(firstDifference(one, other)).toMatchObject({ time: 10 });
  });
});

describe("recordingsWith", () => {
  const info = (name: string, title = "", text = "", mark = ""): RecordingInfo => ({
    name,
    bytes: 1,
    modified: 0,
    system: "",
    net_hash: "",
    clock: "simulated",
    duration: 1,
    notes: title || text || mark ? { title, text, marks: mark ? [{ t: 0, text: mark }] : [], revision: "", problem: "" } : null,
  });
  it("finds names, notes and marks by all words", () => {
    const list = [
      info("a-1"),
      info("a-2", "Slow sensor"),
      info("a-3", "", "the sensor hangs"),
      info("a-4", "", "", "Sensor slow"),
    ];
    const names = (words: string) => recordingsWith(list, words).map(({ name }) => name);
    expect(names("sensor")).toEqual(["a-2", "a-3", "a-4"]);
    expect(names("SLOW sensor")).toEqual(["a-2", "a-4"]);
    expect(names("a-1")).toEqual(["a-1"]);
    expect(names(" ")).toHaveLength(4);
  });
});
