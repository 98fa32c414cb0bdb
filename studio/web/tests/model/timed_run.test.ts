import { expect, test } from "vitest";
import { histogramOf, measuredOf, saidTimes, worstOf } from "../../model/measured_times";
import type { MeasuredChain, TimedChain } from "../../model/protocol";
import { carriersOf, drawnRun, partsOf, runSizes, type TimedRun } from "../../model/timed_run";

const ms = 1e6;
const path = ["robot.sensor", "robot.control", "robot.motor"];
const call = (subsystem: string, behaviour: string, begin: number, end: number) => ({
  subsystem: `robot.${subsystem}`,
  behaviour,
  begin_ns: begin * ms,
  end_ns: end * ms,
});

/** The slowest reaction of the line follower, as docs/theory/timing.md tells it: 142 ms. */
const reaction: TimedRun = {
  from_ns: 80 * ms,
  to_ns: 222 * ms,
  calls: [
    call("sensor", "watch", 80, 82),
    call("sensor", "watch", 100, 102),
    call("control", "follow", 100, 108),
    call("motor", "drive", 120, 122),
    call("control", "follow", 150, 152),
    call("control", "follow", 200, 208),
    call("motor", "drive", 180, 182),
    call("motor", "drive", 220, 222),
  ],
  hops: [
    { channel: "line", from: "robot.sensor", to: "robot.control", written_ns: 102 * ms, read_ns: 152 * ms },
    { channel: "motion", from: "robot.control", to: "robot.motor", written_ns: 208 * ms, read_ns: 208 * ms },
  ],
};

test("the parts of a run follow the value, and add up to its time", () => {
  const parts = partsOf(reaction, path, "reaction");
  expect(parts.map(({ kind, lane, from, to }) => [kind, lane, from / ms, to / ms])).toEqual([
    ["waits", 0, 80, 100],
    ["works", 0, 100, 102],
    ["stands", 0, 102, 152],
    ["waits", 1, 152, 200],
    ["works", 1, 200, 208],
    ["waits", 2, 208, 220],
    ["works", 2, 220, 222],
  ]);
  expect(parts.reduce((sum, { from, to }) => sum + to - from, 0)).toBe(142 * ms);
  expect(parts[0]!.text).toContain("until it reads again");
});

test("an age begins with the call that reads, and ends with the last command of the value", () => {
  const age = { ...reaction, from_ns: 100 * ms };
  expect(partsOf(age, path, "age")[0]).toMatchObject({ kind: "works", lane: 0 });
  expect(partsOf(age, path, "age").at(-2)!.text).toContain("last call that uses the value");
});

test("a call that the recording lacks is a wait; without hops there are no parts", () => {
  const lacking = { ...reaction, calls: reaction.calls.filter(({ begin_ns }) => begin_ns < 150 * ms) };
  const parts = partsOf(lacking, path, "reaction");
  expect(parts.reduce((sum, { from, to }) => sum + to - from, 0)).toBe(142 * ms);
  expect(partsOf({ ...reaction, hops: [] }, path, "reaction")).toEqual([]);
  expect(carriersOf({ ...reaction, hops: [] }, path)).toEqual([]);
});

test("the drawing has a lane for each subsystem, in their order, and times from left to right", () => {
  const drawn = drawnRun(reaction, path, "reaction", 400);
  expect(drawn.lanes.map(({ subsystem }) => subsystem)).toEqual(path);
  expect(drawn.lanes.map(({ y }) => y)).toEqual([0, 1, 2].map((lane) => runSizes.top + lane * runSizes.lane + runSizes.name));
  expect(drawn.calls.filter(({ carries }) => carries).map(({ call: { begin_ns } }) => begin_ns / ms)).toEqual([100, 200, 220]);
  for (const one of drawn.calls) {
    expect(one.x).toBeGreaterThanOrEqual(runSizes.side);
    expect(one.x + one.width).toBeLessThanOrEqual(400 - runSizes.side + 2);
  }
  const places = drawn.line.map(({ x }) => x);
  expect(places).toEqual([...places].sort((a, b) => a - b));
  expect(drawn.line).toHaveLength(6);
  expect(drawn.arrows[0]!.y2 - drawn.arrows[0]!.y1).toBe(runSizes.lane);
  expect(drawn.timeAt(drawn.x(150 * ms))).toBeCloseTo(150 * ms, -1);
  expect(drawn.timeAt(-50)).toBeLessThan(reaction.from_ns);
});

test("a run without calls is drawn, too", () => {
  const drawn = drawnRun({ from_ns: 0, to_ns: 0, calls: [], hops: [] }, path, "age", 300);
  expect(drawn.lanes).toHaveLength(3);
  expect(Number.isFinite(drawn.begin.x)).toBe(true);
  expect(drawn.line).toEqual([]);
});

const times = {
  count: 4,
  least_ns: 20 * ms,
  median_ns: 30 * ms,
  p95_ns: 60 * ms,
  p99_ns: 60 * ms,
  most_ns: 60 * ms,
  histogram: [3, 0, 0, 1],
};

test("a histogram goes from 0 beyond the bound", () => {
  const found = histogramOf(times, 100 * ms)!;
  expect(found.end_ns).toBeGreaterThan(100 * ms);
  expect(found.bars.map(({ count }) => count)).toEqual([3, 1]);
  expect(found.bars[0]!.height).toBe(1);
  expect(found.bars[0]!.from * found.end_ns).toBeCloseTo(20 * ms);
  expect((found.bars[1]!.from + found.bars[1]!.width) * found.end_ns).toBeCloseTo(60 * ms);
  expect(found.bound! * found.end_ns).toBeCloseTo(100 * ms);
  expect(histogramOf(times, null)!.bound).toBeNull();
  expect(histogramOf({ ...times, most_ns: 20 * ms, histogram: [] }, null)!.bars.map(({ count }) => count)).toEqual([4]);
  expect(histogramOf({ count: 0 }, 1)).toBeUndefined();
});

test("measured times are told beside the bound", () => {
  expect(saidTimes(times, 100 * ms)).toBe("4 measured: median 30 ms, 99 % within 60 ms, longest 60 ms, 60 % of the bound");
  expect(saidTimes({ count: 0 }, null)).toBe("nothing is measured");
});

test("a chain has the times of its fleet, and its worst case as a run", () => {
  const worst = { chain: "quick", from_ns: 1, to_ns: 2, calls: [], hops: [] };
  const measured: MeasuredChain = {
    chain: "robot[].sensor -> robot[].motor",
    chains: 3,
    name: "robot[0].sensor -> robot[0].motor",
    named: false,
    path: ["robot[0].sensor", "robot[0].motor"],
    age: { ...times, worst },
    reaction: { count: 0 },
    withheld: 0,
    exceeds: false,
  };
  const bound = { at_most_ns: null, asked_ns: null, answer: "not_asked" } as const;
  const chain: TimedChain = {
    ...{ name: "robot[2].sensor -> robot[2].motor", named: false, path: ["robot[2].sensor", "robot[2].motor"] },
    ...{ channels: [], agents: 1, age: bound, reaction: bound, exact: false, why: "" },
  };
  expect(measuredOf([measured], chain)).toBe(measured);
  expect(worstOf(measured.age)).toBe(worst);
  expect(worstOf(measured.reaction)).toBeUndefined();
});
