import { afterAll, beforeEach, describe, expect, it, vi } from "vitest";
import type { Api } from "../../live/api";
import type { Connection } from "../../live/stream/connection";
import type { Draft } from "../../live/draft";
import type { ControlRequest, RunInfo } from "../../model/protocol";
import { Runner } from "../../live/run/runner";
import { NetModel } from "../../model/net/net";
import { lineFollower } from "../model/line_follower";

const net = lineFollower();
const named = (name: string) => net.transitionByName.get(name)!;

afterAll(() => {
  vi.useRealTimers();
  vi.unstubAllGlobals();
});
beforeEach(() => {
  vi.useFakeTimers();
  vi.stubGlobal("requestAnimationFrame", () => 1);
});

/** A runner whose server has one run, and a function that sends an event of that run. */
function served(drawn: NetModel | null = net) {
  const heard = new Map<string, (data: object) => void>();
  const connection = { on: (name: string, handler: (data: object) => void) => void heard.set(name, handler) };
  const info: RunInfo = {
    run: "1",
    state: "running",
    kind: "simulate",
    why: "",
    net_hash: "",
    t: 5,
    marking: [],
    firings: 3,
    values: { "robot.control.motion": { linear: 1, angular: 2 } },
    notices: { notices: [], dropped: 0 },
    pose: null,
    scene: null,
    poses: null,
    path: [
      [0, 0, 0, 0],
      [4, 1, 0, 0],
    ],
    subsystems: null,
    parameters: [],
    panels: [],
    deployment: null,
    verdicts: null,
    outcome: null,
    track: null,
  };
  const runs = [info];
  const asked: [string, ControlRequest][] = [];
  const api = {
    start: async () => ({ run: "1" }),
    run: async (run: string) => runs.find((one) => one.run === run)!,
    runs: async () => runs,
    floor: async () => null,
    control: async (run: string, request: ControlRequest) => void asked.push([run, request]),
  };
  const draft = { store: { get: () => ({ net: drawn }) } };
  const runner = new Runner(api as unknown as Api, draft as unknown as Draft, connection as unknown as Connection);
  return { runner, info, runs, api, asked, tell: (name: string, data: object) => heard.get(name)!({ run: "1", ...data }) };
}

/** The same after the page has started the run. */
async function watching() {
  const all = served();
  await all.runner.start({ kind: "simulate" });
  return all;
}

describe("Runner", () => {
  it("is told of what a controller prints in one go, and keeps the last lines", async () => {
    const { runner, tell } = await watching();
    let told = 0;
    runner.store.subscribe(() => (told += 1));
    for (let line = 0; line < 5000; line += 1) tell("log", { line: String(line) });
    vi.advanceTimersByTime(200);
    expect(told).toBe(1);
    const { build } = runner.store.get();
    expect(build.length).toBeLessThanOrEqual(400);
    expect(build.at(-1)).toBe("4999");
  });
  it("keeps values that are not told anew, and the path before it looked", async () => {
    const { runner, tell } = await watching();
    tell("values", { t: 8, values: { "robot.control.motion": { linear: 3 } } });
    tell("pose", { t: 9, x: 2, y: 0, heading: 0 });
    const { series, path } = runner.track!;
    expect(series.at("robot.control.motion.linear", 8)).toBe(3);
    expect(series.at("robot.control.motion.angular", 8)).toBe(2);
    expect(path.map(({ x }) => x)).toEqual([0, 1, 2]);
  });
  it("counts what was dropped, and takes what runs from the marking that comes with it", async () => {
    const { runner, tell } = await watching();
    const marking = [net.placeByName.get("robot.control.follow.in")!];
    tell("firings", { t: 9, dropped: 7000, total: 7001, firings: [[8, named("robot.control.t_in")]], marking });
    const { firings, dropped, timeline } = runner.track!;
    expect([firings, dropped]).toEqual([7001, 7000]);
    expect(timeline.lanes[0]!.segments.map(({ behaviour }) => behaviour)).toEqual(["init", "follow"]);
  });
  it("counts firings although it was not told of them, or heard of them before the run had a name", async () => {
    const { runner, tell } = await watching();
    expect([runner.track!.firings, runner.track!.dropped]).toEqual([3, 3]);
    expect(runner.stage.sampled).toBe(true);
    const fired = [[8, named("robot.control.t_in")]];
    tell("firings", { t: 9, dropped: 0, total: 90, firings: fired });
    expect([runner.track!.firings, runner.track!.dropped]).toEqual([90, 89]);
    // The answer to an older question arrives late.
    tell("firings", { t: 9, dropped: 0, total: 91, firings: fired });
    expect([runner.track!.firings, runner.track!.dropped]).toEqual([91, 89]);
  });
  it("hears of the end of its run although the stream was broken then", async () => {
    const { runner, tell, info } = await watching();
    Object.assign(info, { state: "ended", why: "time is up", firings: 40 });
    tell("hello", {});
    await vi.waitFor(() => expect(runner.store.get().state).toBe("ended"));
    expect(runner.store.get().why).toBe("time is up");
    expect(runner.track!.firings).toBe(40);
  });
  it.each([
    ["has errors", null],
    ["has another net", Object.assign(lineFollower(), { hash: "b" })],
  ])("stops a run that it finds, although the text %s", async (_, drawn) => {
    const { runner, info, tell, asked } = served(drawn);
    info.net_hash = "a";
    tell("hello", {});
    await vi.waitFor(() => expect(runner.store.get().run).toBe("1"));
    expect(runner.track).toBeNull();
    expect(runner.active).toBe(true);
    await runner.control({ command: "stop" });
    expect(asked).toEqual([["1", { command: "stop" }]]);
  });
  it("follows a run that another page starts, if it follows none", async () => {
    const { runner, tell } = served();
    tell("run", { state: "building" });
    await vi.waitFor(() => expect(runner.store.get().run).toBe("1"));
    expect(runner.store.get().shown).toBe(true);
  });
  it("lists the runs of other pages, and stops them", async () => {
    const { runner, info, runs, tell, asked } = await watching();
    runs.push({ ...info, run: "2", kind: "run" });
    tell("run", { run: "2", state: "building" });
    await vi.waitFor(() => expect(runner.store.get().others.map(({ run }) => run)).toEqual(["2"]));
    expect(runner.store.get().run).toBe("1");
    await runner.stopOther("2");
    expect(asked).toEqual([["2", { command: "stop" }]]);
    // The end of its own run changes nothing for the other one.
    info.state = "ended";
    tell("run", { state: "ended", why: "", outcome: null, marking: [], firings: 9 });
    tell("hello", {});
    await vi.waitFor(() => expect(runner.store.get().state).toBe("ended"));
    expect(runner.store.get().others.map(({ run }) => run)).toEqual(["2"]);
    await runner.follow("2");
    expect([runner.store.get().run, runner.store.get().others]).toEqual(["2", []]);
  });
  it("shows why a run is refused, and the run that is in its way", async () => {
    const { runner, info, api } = served();
    info.kind = "run";
    api.start = async () => Promise.reject(new Error("run 1 goes on"));
    await runner.start({ kind: "run" });
    const { state, problem, others } = runner.store.get();
    expect([state, problem, others.map(({ run }) => run)]).toEqual(["failed", "run 1 goes on", ["1"]]);
  });
  it("names breakpoints, and says which of them the net of the run does not have", async () => {
    const { runner, asked } = await watching();
    const path = "robot.control.t_in";
    runner.toggleBreakpoint({ on: "transition", path });
    runner.toggleBreakpoint({ on: "place", path: "robot.gone.in" });
    await vi.waitFor(() => expect(runner.store.get().problem).toContain("robot.gone.in"));
    expect(asked.at(-1)).toEqual(["1", { command: "breakpoints", breakpoints: [{ transition: named(path) }] }]);
  });
});
