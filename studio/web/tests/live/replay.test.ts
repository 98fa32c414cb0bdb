import { afterAll, beforeAll, describe, expect, it, vi } from "vitest";
import { Replay } from "../../live/run/replay";
import { lineFollower } from "../model/line_follower";
import { recordingOf } from "./recording";

const net = lineFollower();
const named = (name: string) => net.transitionByName.get(name)!;
const held = (replay: Replay) => [...net.places].flatMap(({ name }, at) => (replay.stage.marking[at]! > 0 ? [name] : []));

afterAll(() => vi.unstubAllGlobals());
beforeAll(() => vi.stubGlobal("requestAnimationFrame", () => 1));

describe("Replay", () => {
  it("shows what was driven up to its moment, also after a jump back", () => {
    const replay = new Replay(
      "x",
      net,
      recordingOf({
        firings: [
          [10, named("t_in")],
          [40, named("robot.t_in")],
        ],
        path: [
          [0, 0, 0, 0],
          [20, 1, 0, 0],
          [40, 2, 0, 0],
        ],
      }),
    );
    expect(replay.track.driven).toBe(1);
    replay.seek(40);
    expect(replay.track.driven).toBe(3);
    replay.seek(25);
    expect(replay.track.driven).toBe(2);
    expect(replay.stage.counts[named("robot.t_in")]).toBe(0);
    expect(replay.stage.counts[named("t_in")]).toBe(1);
  });
  it("begins with the marking that a later segment begins with", () => {
    const marking = [net.placeByName.get("robot.in")!];
    const replay = new Replay("x", net, recordingOf({ firings: [[50, named("robot.t_in")]], marking }));
    expect(held(replay)).not.toContain("robot.in");
    expect(held(replay)).toContain("robot.control.in");
  });
  it("begins with what the firings need when nobody knows the marking", () => {
    const firings: [number, number][] = [
      [50, named("robot.t_in")],
      [60, named("robot.control.t_in")],
    ];
    const replay = new Replay("x", net, recordingOf({ firings, marking: [] }));
    expect(held(replay)).toContain("robot.control.in");
    replay.seek(60);
    expect(held(replay)).toContain("robot.control.init.in");
    expect([...replay.stage.marking].every((tokens) => tokens >= 0)).toBe(true);
  });
  it("gets the part of a long recording in which the moment is, with what was before it", async () => {
    const all: [number, number][] = [
      [10, named("t_in")],
      [40, named("robot.t_in")],
      [70, named("robot.control.t_in")],
      [71, named("robot.control.init.t1")],
    ];
    const ends = { first: 10, last: 71, total: 4 };
    const asked: number[] = [];
    const source = (from: number) => {
      asked.push(from);
      const firings = all.filter(([time]) => time >= from).slice(0, 2);
      const marking =
        from > 40 ? [net.placeByName.get("robot.control.in")!] : from > 10 ? [net.placeByName.get("robot.in")!] : null;
      const dropped = all.filter(([time]) => time >= from).length - firings.length;
      return Promise.resolve(recordingOf({ ...ends, firings, marking, dropped }));
    };
    let parts = 0;
    const replay = new Replay(
      "x",
      net,
      recordingOf({ ...ends, firings: all.slice(0, 2), dropped: 2 }),
      source,
      () => (parts += 1),
    );
    const loaded = async () => {
      while (replay.store.get().loading) await Promise.resolve();
    };
    const before = replay.track;
    replay.seek(71);
    expect(replay.store.get().loading).toBe(true);
    await loaded();
    expect(replay.store.get().time).toBe(71);
    expect(held(replay)).toContain("robot.control.init.snd.in");
    expect(replay.track).not.toBe(before);
    expect(replay.track.firings).toBe(4);
    expect(parts).toBe(asked.length);
    replay.seek(10);
    await loaded();
    expect(held(replay)).toContain("robot.in");
  });
  it("steps over what fired at the same moment", () => {
    const replay = new Replay(
      "x",
      net,
      recordingOf({
        firings: [
          [10, named("t_in")],
          [40, named("robot.t_in")],
          [40, named("robot.control.t_in")],
        ],
      }),
    );
    replay.step(1);
    expect(replay.track.now).toBe(40);
    replay.step(-1);
    expect(replay.track.now).toBe(10);
  });
});
