import { afterAll, beforeEach, describe, expect, it, vi } from "vitest";
import type { FiringRow } from "../../model/protocol";
import type { Recordings, RecordingsState } from "../../live/recordings";
import { Replay } from "../../live/run/replay";
import type { Runner } from "../../live/run/runner";
import type { RunnerState } from "../../live/run/runner_state";
import { Scene } from "../../live/scene";
import { Stage } from "../../live/stage";
import { Store } from "../../live/store";
import { Track } from "../../live/run/track";
import { lineFollower } from "../model/line_follower";
import { recordingOf } from "./recording";

const net = lineFollower();
const named = (name: string) => net.transitionByName.get(name)!;
const second = 1e9;

/** The control subsystem begins with init at the first second, and goes on to follow at a later one. */
const run = (follow: number): FiringRow[] => [
  [0, named("t_in")],
  [1 * second, named("robot.control.t_in")],
  [follow * second, named("robot.control.t_init_1")],
  [9 * second, named("robot.control.follow.t1")],
];

let frames = new Map<number, () => void>();
let asked = 0;
let now = 0;
/** Lets the page draw a frame, long after the last one. */
const frame = () => {
  now += 1000;
  const due = frames;
  frames = new Map();
  due.forEach((one) => one());
};

afterAll(() => {
  vi.unstubAllGlobals();
  vi.restoreAllMocks();
});
beforeEach(() => {
  frames = new Map();
  vi.stubGlobal("requestAnimationFrame", (one: () => void) => (frames.set((asked += 1), one), asked));
  vi.stubGlobal("cancelAnimationFrame", (one: number) => frames.delete(one));
  vi.spyOn(performance, "now").mockImplementation(() => now);
});

function studio() {
  const desk = new Stage();
  const live = new Track(net);
  const runner = {
    store: new Store<Pick<RunnerState, "shown">>({ shown: false }),
    stage: new Stage(),
    track: live,
    active: true,
    show: (shown: boolean) => runner.store.set({ shown }),
  };
  const recordings = {
    store: new Store<Pick<RecordingsState, "open">>({ open: [] }),
    keep: (most: number) => recordings.store.get().open.length > most && open(...recordings.store.get().open.slice(0, most)),
    close: (replay: Replay) => open(...recordings.store.get().open.filter((one) => one !== replay)),
  };
  const open = (...all: Replay[]) => recordings.store.set({ open: all });
  const scene = new Scene(desk, runner as unknown as Runner, recordings as unknown as Recordings);
  const ids = () => scene.store.get().panes.map(({ id }) => id);
  return { desk, live, runner, scene, ids, open };
}
const replayOf = (follow: number) => new Replay("x", net, recordingOf({ firings: run(follow) }));

describe("Scene", () => {
  it("shows the run left and a recording right, never more than two, and a game alone", () => {
    const { desk, runner, scene, ids, open } = studio();
    const [one, other] = [replayOf(3), replayOf(4)];
    expect(ids()).toEqual(["desk"]);
    open(one, other);
    expect(ids()).toEqual([one.id, other.id]);
    runner.show(true);
    expect(ids()).toEqual(["run", one.id]);
    desk.reset(net, "game");
    expect(ids()).toEqual(["desk"]);
    desk.reset(net, "edit");
    scene.close(scene.store.get().panes[0]!);
    expect(ids()).toEqual([one.id]);
    scene.close(scene.store.get().panes[0]!);
    expect(ids()).toEqual(["desk"]);
  });

  it("says what differs at the right one's moment, and marks it when both show the same", () => {
    const { scene, open } = studio();
    const [left, right] = [replayOf(3), replayOf(6)];
    open(left, right);
    right.seek(4 * second);
    frame();
    const difference = { path: "robot.control", behaviours: ["follow", "init"] };
    expect(scene.store.get().comparison).toEqual({ time: 4 * second, missing: null, differences: [difference] });
    expect(left.stage.differing.size).toBe(0);
    scene.lock(true);
    left.seek(5 * second);
    frame();
    expect(right.track.now).toBe(5 * second);
    frame();
    expect([...left.stage.differing]).toEqual(["robot.control"]);
    left.seek(7 * second);
    frame();
    expect(scene.store.get().comparison?.differences).toEqual([]);
    expect(right.stage.differing.size).toBe(0);
  });

  it("compares nothing with a run that has not come so far, was sampled only, or after the end", () => {
    const { live, runner, scene, open } = studio();
    const replay = replayOf(3);
    runner.show(true);
    open(replay);
    replay.seek(5 * second);
    frame();
    expect(scene.store.get().comparison?.missing).toBe("left");
    for (const [time, transition] of run(6)) live.timeline.add(time, transition);
    live.known = 20 * second;
    live.reached(20 * second);
    frame();
    expect(scene.store.get().comparison).toMatchObject({ missing: null, differences: [{ behaviours: ["init", "follow"] }] });
    live.firings = live.listed + 1;
    frame();
    expect(scene.store.get().comparison?.missing).toBe("sampled");
    scene.lock(true);
    frame();
    expect(scene.store.get().comparison?.missing).toBe("right");
  });
  it("compares a long recording only where its part is here, and nothing while a part is on its way", () => {
    const { scene, open } = studio();
    const ends = { first: 0, last: 9 * second, total: 4 };
    const long = new Replay("long", net, recordingOf({ ...ends, firings: run(3).slice(0, 3), dropped: 1 }));
    const right = replayOf(4);
    open(long, right);
    right.seek(2 * second);
    frame();
    expect(scene.store.get().comparison?.missing).toBe(null);
    right.seek(5 * second);
    frame();
    expect(scene.store.get().comparison?.missing).toBe("part");
    open(right, long);
    frame();
    long.seek(8 * second);
    right.seek(8 * second);
    expect(long.store.get().loading).toBe(true);
    const told = scene.store.get().comparison;
    frame();
    expect(scene.store.get().comparison).toBe(told);
  });
});
