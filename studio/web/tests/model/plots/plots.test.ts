import { describe, expect, it } from "vitest";
import { plotsOf } from "../../../live/plots/plots";
import { ageOf, ArrivalLog, rateOf } from "../../../model/plots/arrivals";
import { bandsOf, drawnCurves, type Curve } from "../../../model/plots/drawn_curves";
import { statesOf } from "../../../model/plots/plotted_runs";
import { chartsOf, signalOf, titleOf } from "../../../model/plots/signals";
import { statisticsOf, valueAt } from "../../../model/plots/statistics";
import { csvOf } from "../../../model/run/csv";
import { Series } from "../../../model/run/series";

const s = 1e9;
const curve = (times: number[], values: number[], more: Partial<Curve> = {}): Curve => ({
  samples: { times: times.map((time) => time * s), values },
  course: "hold",
  shift: 0,
  until: Infinity,
  ...more,
});

describe("statisticsOf", () => {
  const samples = { times: [0, 1 * s, 4 * s], values: [2, 6, 0] };
  it("counts a value as long as it holds", () => {
    const facts = statisticsOf(samples, 0, 4 * s)!;
    expect(facts).toMatchObject({ min: 0, max: 6, count: 3, rate: 0.75 });
    expect(facts.mean).toBeCloseTo((2 + 3 * 6) / 4);
    expect(facts.std).toBeCloseTo(Math.sqrt((4 + 3 * 36) / 4 - 25));
  });
  it("begins with the value from before the span, and ends where nothing is known any more", () => {
    expect(statisticsOf(samples, 2 * s, 3 * s)).toMatchObject({ min: 6, max: 6, mean: 6, std: 0, count: 0, rate: 0 });
    expect(statisticsOf(samples, 3 * s, 9 * s, "hold", 5 * s)!.mean).toBeCloseTo(3);
    expect(statisticsOf(samples, -5 * s, -1 * s)).toBeNull();
  });
  it("leaves a gap out", () => {
    const facts = statisticsOf({ times: [0, 1 * s, 3 * s], values: [2, NaN, 8] }, 0, 4 * s)!;
    expect(facts).toMatchObject({ min: 2, max: 8, mean: 5, count: 2 });
  });
  it("takes the mean of a slope", () => {
    const facts = statisticsOf({ times: [0, 2 * s], values: [0, 4] }, 0, 2 * s, "slope")!;
    expect(facts.mean).toBeCloseTo(2);
    expect(facts.std).toBeCloseTo(4 / Math.sqrt(12));
    expect(valueAt({ times: [0, 2 * s], values: [0, 4] }, 0.5 * s, "slope")).toBe(1);
  });
});

describe("chartsOf", () => {
  const of = (...units: string[]) => units.map((unit, at) => ({ unit, at }));
  it("gives the first unit the left axis, the second the right one, and each further unit a chart of its own", () => {
    expect(chartsOf(of("m", "rad", "m", "s", "", "s"))).toEqual([
      {
        left: "m",
        right: "rad",
        signals: [
          { unit: "m", at: 0 },
          { unit: "rad", at: 1 },
          { unit: "m", at: 2 },
        ],
      },
      {
        left: "s",
        right: null,
        signals: [
          { unit: "s", at: 3 },
          { unit: "s", at: 5 },
        ],
      },
      { left: "", right: null, signals: [{ unit: "", at: 4 }] },
    ]);
    expect(chartsOf(of("m"))).toMatchObject([{ left: "m", right: null }]);
    expect(chartsOf([])).toEqual([]);
  });
});

describe("drawnCurves", () => {
  it("draws every sample while they are few, from edge to edge", () => {
    expect(drawnCurves([curve([0, 1, 5], [1, 2, 3]), curve([2], [7])], 0.5 * s, 4 * s, 100)).toEqual([
      [0.5, 1, 2, 4],
      [1, 2, 2, 2],
      [null, null, 7, 7],
    ]);
  });
  it("keeps gaps, shifts another run, and ends with what is known", () => {
    const [times, values] = drawnCurves([curve([0, 1, 2], [1, NaN, 3], { shift: 10 * s, until: 3 * s })], 10 * s, 15 * s, 100);
    expect(times).toEqual([10, 11, 12, 13, 15]);
    expect(values).toEqual([1, null, 3, 3, null]);
  });
  it("draws both values of an age that drops", () => {
    expect(drawnCurves([curve([0, 1, 1, 2], [0, 1, 0, 1], { course: "slope" })], 0, 2 * s, 100)).toEqual([
      [0, 1, 1, 2],
      [0, 1, 0, 1],
    ]);
  });
  it("loses no peak and no gap of a million points, and reads them only once", () => {
    const count = 1_000_000;
    const values = Array.from({ length: count }, () => 0);
    values[123_456] = 9;
    values[765_432] = -4;
    values[500_000] = NaN;
    const big = curve(
      Array.from({ length: count }, (_, at) => at / 1000),
      values,
    );
    const [times, drawn] = drawnCurves([big], 0, 1000 * s, 1000);
    expect(times.length).toBe(2000);
    expect(Math.max(...drawn!.map(Number))).toBe(9);
    expect(Math.min(...drawn!.map(Number))).toBe(-4);
    expect(drawn!.filter((one) => one === null).length).toBe(1);
    let read = 0;
    const counted = new Proxy(values, { get: (of, key) => ((read += 1), Reflect.get(of, key) as unknown) });
    const same = { ...big, samples: { times: big.samples.times, values: counted } };
    drawnCurves([same], 0, 1000 * s, 100);
    read = 0;
    expect(drawnCurves([same], 0, 999 * s, 100)[1]!.includes(9)).toBe(true);
    expect(read).toBeLessThan(100_000);
  });
});

describe("ages and rates of an input", () => {
  const log = new ArrivalLog();
  // Written every 100 ms, read 20 ms later.
  for (let at = 0; at < 20; at += 1) log.add("a.b.line", at * 0.1 * s + 0.02 * s, at * 0.1 * s, true);
  const arrivals = log.byPath.get("a.b.line")!;
  it("grows from the delay of the channel until the next value comes", () => {
    const age = ageOf(arrivals, 2.5 * s);
    expect(valueAt(age, 0.52 * s, "slope")).toBeCloseTo(0.02);
    expect(valueAt(age, 0.57 * s, "slope")).toBeCloseTo(0.07);
    expect(valueAt(age, 2.5 * s, "slope")).toBeCloseTo(0.6);
    const facts = statisticsOf(age, 1 * s, 1.9 * s, "slope")!;
    expect(facts.max).toBeCloseTo(0.12);
    expect(facts.count).toBe(9);
  });
  it("counts new values in the last second", () => {
    const rate = rateOf(arrivals, 4 * s);
    expect(rate.times[0]).toBeGreaterThanOrEqual(1.02 * s);
    expect(valueAt(rate, 1.5 * s)).toBe(10);
    expect(valueAt(rate, 2.47 * s)).toBe(5);
    expect(valueAt(rate, 3.5 * s)).toBe(0);
  });
  it("knows nothing of a value that is not valid, or while arrivals are missing", () => {
    const other = new ArrivalLog();
    other.add("x", 1 * s, 1 * s, true);
    other.add("x", 2 * s, 0, false);
    other.add("x", 3 * s, 3 * s, true);
    other.interrupt(4 * s);
    expect(other.isInvalid("x")).toBe(false);
    const age = ageOf(other.byPath.get("x")!, 5 * s);
    expect(valueAt(age, 2.5 * s, "slope")).toBeNaN();
    expect(valueAt(age, 4.5 * s, "slope")).toBeNaN();
  });
  it("gives no rate until a whole second is known again after missing arrivals", () => {
    const other = new ArrivalLog();
    for (let at = 0; at < 20; at += 1) other.add("x", at * 0.1 * s, at * 0.1 * s, true);
    other.interrupt(2 * s);
    for (let at = 51; at < 70; at += 1) other.add("x", at * 0.1 * s, at * 0.1 * s, true);
    other.interrupt(7 * s);
    const rate = rateOf(other.byPath.get("x")!, 8 * s);
    expect(valueAt(rate, 1.55 * s)).toBe(10);
    for (const time of [2.5, 5.3, 5.9, 7.5]) expect(valueAt(rate, time * s)).toBeNaN();
    expect(valueAt(rate, 6.55 * s)).toBe(10);
    expect(rate.values.filter((value) => value < 9)).toEqual([]);
  });
});

describe("a value that its device does not give any more", () => {
  const series = new Series();
  series.add(1 * s, "robot.sensor.line", { left: true, level: 3 });
  series.add(2 * s, "robot.sensor.line", null);
  it("is a gap until the next value", () => {
    expect(series.samples.get("robot.sensor.line.level")).toEqual({ times: [1 * s, 2 * s], values: [3, NaN] });
    expect(series.at("robot.sensor.line.level", 2.5 * s)).toBeUndefined();
    series.regain(3 * s, "robot.sensor.line");
    expect(series.at("robot.sensor.line.left", 3 * s)).toBe(true);
    expect(csvOf([{ path: "x,y", samples: series.samples.get("robot.sensor.line.level")! }])).toBe(
      'time_s,"x,y"\n1.000000000,3\n2.000000000,\n3.000000000,3\n',
    );
  });
  it("is drawn as a state if it is true or false, with its gap", () => {
    const run = { series, arrivals: new ArrivalLog(), timeline: { lanes: [] }, end: 4 * s };
    const states = statesOf(run, { kind: "value", path: "robot.sensor.line.left" })!;
    expect(states.map(({ state }) => state)).toEqual(["true", "", "true"]);
    expect(bandsOf(states, 0, 4 * s, 4 * s, 100)).toEqual([
      { from: 1 * s, to: 2 * s, state: "true" },
      { from: 3 * s, to: 4 * s, state: "true" },
    ]);
  });
  it("a number that is not finite is a gap, too", () => {
    series.add(5 * s, "robot.sensor.line.level", "nan");
    expect(series.samples.get("robot.sensor.line.level")!.values.at(-1)).toBeNaN();
  });
});

describe("the plots that a browser keeps", () => {
  it("are read as far as they make sense", () => {
    const kept = plotsOf(
      JSON.stringify({
        plots: [{ title: "Line", signals: [{ kind: "age", path: "a.b" }, { kind: "x", path: "c" }, 7] }],
        active: 4,
      }),
    );
    expect(kept.active).toBe(0);
    expect(kept.plots[0]).toMatchObject({ title: "Line", signals: [{ kind: "age", path: "a.b" }], alignment: { by: "clock" } });
    for (const text of [null, "{", "[]", '{"plots":[]}', "7"]) expect(plotsOf(text).plots).toHaveLength(1);
  });
  it("refuse what is no signal", () => {
    expect(signalOf({ kind: "value", path: "" })).toBeNull();
    expect(signalOf(null)).toBeNull();
    expect(titleOf({ kind: "rate", path: "a.b.c" })).toBe("rate of a.b.c");
  });
});
