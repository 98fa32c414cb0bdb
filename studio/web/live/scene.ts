import { differences, type Difference } from "../model/run/timeline";
import type { Recordings } from "./recordings";
import type { Replay } from "./run/replay";
import type { Runner } from "./run/runner";
import type { Stage } from "./stage";
import { Store } from "./store";
import type { Track } from "./run/track";

/** One drawing of a net: of the text, of a run, or of a recording. */
export interface Pane {
  id: string;
  stage: Stage;
  track: Track | null;
  /** The recording, if the pane shows one. */
  replay: Replay | null;
}

/**
 * The differences between two panes at the time of the right one, or of the left one
 * if they show the same time.
 */
export interface Comparison {
  /** Nanoseconds. */
  time: number;
  differences: readonly Difference[];
  /**
   * Why they cannot be compared: one of them does not exist yet, or no longer, at that time; or only samples
   * of the left one are known; or another part of its long recording is loaded.
   */
  missing: "left" | "right" | "sampled" | "part" | null;
}

export interface SceneState {
  /** One pane, or two side by side. */
  panes: readonly Pane[];
  /** Whether the right pane shows the same time as the left one. */
  sameTime: boolean;
  comparison: Comparison | null;
}

/** The last firings are a little before the end of a run (in ns). */
const slack = 0.5e9;
/** Milliseconds between two comparisons. */
const pause = 100;

/** The panes, and the comparison of two panes side by side. */
export class Scene {
  readonly store: Store<SceneState>;
  private frame = 0;
  private compared = 0;

  constructor(
    private readonly desk: Stage,
    private readonly runner: Runner,
    private readonly recordings: Recordings,
  ) {
    this.store = new Store<SceneState>({ panes: this.panes([]), sameTime: false, comparison: null });
    for (const told of [desk.shown, runner.store, recordings.store]) told.subscribe(() => this.look());
  }

  /** The number of recordings that fit beside the other panes. */
  get room(): number {
    return this.runner.store.get().shown ? 1 : 2;
  }

  private look(): void {
    const { panes } = this.store.get();
    const next = this.panes(panes);
    if (next.length === panes.length && next.every((pane, at) => pane === panes[at])) return;
    this.store.set({ panes: next, comparison: null, ...(next.length < 2 ? { sameTime: false } : {}) });
    for (const pane of [...panes, ...next]) pane.stage.differ(new Set());
    cancelAnimationFrame(this.frame);
    if (next.length === 2) this.tick();
    this.recordings.keep(this.room);
  }

  private panes(before: readonly Pane[]): Pane[] {
    const { desk, runner, recordings } = this;
    const shown: Pane[] = [];
    // A game on the text uses the whole drawing until it is closed.
    if (desk.mode === "edit") {
      if (runner.track && runner.store.get().shown)
        shown.push({ id: "run", stage: runner.stage, track: runner.track, replay: null });
      for (const replay of recordings.store.get().open)
        shown.push({ id: replay.id, stage: replay.stage, track: replay.track, replay });
    }
    if (shown.length === 0) shown.push({ id: "desk", stage: desk, track: null, replay: null });
    return shown.slice(0, 2).map((pane) => before.find(({ id, track }) => id === pane.id && track === pane.track) ?? pane);
  }

  lock(sameTime: boolean): void {
    this.store.set({ sameTime });
    if (sameTime) this.store.get().panes[1]?.replay?.play(false);
    else for (const pane of this.store.get().panes) pane.stage.differ(new Set());
  }

  /** Closes a pane. A run continues without being drawn. */
  close(pane: Pane): void {
    if (pane.replay) this.recordings.close(pane.replay);
    else if (this.runner.active) this.runner.show(false);
    else this.runner.close();
  }

  private tick = (): void => {
    this.frame = requestAnimationFrame(this.tick);
    const { panes, sameTime } = this.store.get();
    const [left, right] = panes;
    if (!left?.track || !right?.replay) return;
    if (sameTime) right.replay.follow(left.track.now);
    const now = performance.now();
    if (now - this.compared < pause) return;
    this.compared = now;
    this.compare(left, right);
  };

  private compare(left: Pane, right: Pane): void {
    const { sameTime, comparison } = this.store.get();
    if (right.replay!.store.get().loading) return;
    const moment = right.track!.now;
    const { replay } = left;
    const isElsewhere = !sameTime && replay && moment >= replay.first && moment <= replay.last && !replay.isHere(moment);
    const next: Comparison = isElsewhere
      ? { time: moment, differences: [], missing: "part" }
      : compared(left.track!, right.track!, sameTime);
    if (sameTime) {
      const paths = new Set(next.differences.map(({ path }) => path));
      left.stage.differ(paths);
      right.stage.differ(paths);
    }
    if (JSON.stringify(next) !== JSON.stringify(comparison)) this.store.set({ comparison: next });
  }
}

function compared(left: Track, right: Track, sameTime: boolean): Comparison {
  const moment = sameTime ? left.now : right.now;
  if (moment > right.end + slack) return { time: moment, differences: [], missing: "right" };
  if (!sameTime && moment > left.known) return { time: moment, differences: [], missing: "left" };
  if (!sameTime && left.dropped > 0) return { time: moment, differences: [], missing: "sampled" };
  // In a live run, firings arrive a little after their time; the marking comes with them.
  const time = Math.min(moment, left.known);
  return { time, differences: differences(left.timeline, right.timeline, time), missing: null };
}
