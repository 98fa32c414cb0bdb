import { Paths } from "../model/run/robots";
import { PoseFrames } from "../model/run/pose_frames";
import { count } from "../model/sorted";
import { message } from "./api";
import type { PoseFrame, RecordedPoses, SceneShown } from "../model/protocol";

/** The poses at one time. Another object means other poses. */
export type Poses = Float32Array;

/** A simulated world: its appearance, and the poses of its bodies at a time. */
export interface World {
  readonly scene: SceneShown;
  /** The reason for missing poses; empty: they are there. */
  readonly problem: string;
  /** The paths of all robots, as far as they are known. */
  readonly paths: Paths;
  /** Null: not known, or not loaded yet. */
  at(time: number): Poses | null;
}

/** The world of a running run, shown as it is now. */
export class LiveWorld implements World {
  readonly problem = "";
  readonly paths: Paths;
  private readonly frames: PoseFrames;
  private poses: Poses | null = null;

  constructor(readonly scene: SceneShown) {
    this.frames = new PoseFrames(scene.bodies.length);
    this.paths = new Paths(scene.bodies);
  }

  take({ t, frame }: PoseFrame): void {
    if (!this.frames.take(frame)) return;
    this.poses = this.frames.poses();
    this.paths.take(t, this.poses);
  }

  at(): Poses | null {
    return this.poses;
  }
}

/** Loads the poses between two times. */
export type PoseSource = (from: number, to: number) => Promise<RecordedPoses>;

/** Nanoseconds that are loaded before and after a requested time. */
const before = 2e9;
const after = 30e9;

interface Part {
  times: number[];
  poses: Poses[];
  from: number;
  until: number;
}

/** The world of a recording, of which one part is loaded at a time. */
export class RecordedWorld implements World {
  private part: Part = { times: [], poses: [], from: 0, until: -1 };
  private next: Part | null = null;
  private loading = false;
  problem = "";
  readonly paths: Paths;

  constructor(
    readonly scene: SceneShown,
    private readonly source: PoseSource,
  ) {
    this.paths = new Paths(scene.bodies);
  }

  at(time: number): Poses | null {
    if (this.next && time >= this.next.from && time > this.part.until) [this.part, this.next] = [this.next, null];
    const { times, poses, from, until } = this.part;
    const isHere = time >= from && time <= until;
    if (!isHere) void this.load(time, (part) => ([this.part, this.next] = [part, null]));
    else if (!this.next && time > until - after / 3) void this.load(until + before, (part) => (this.next = part));
    if (!isHere) return null;
    const shown = count(times, (at) => at <= time);
    return shown > 0 ? poses[shown - 1]! : null;
  }

  private async load(time: number, taken: (part: Part) => void): Promise<void> {
    if (this.loading || this.problem) return;
    this.loading = true;
    const from = Math.floor(Math.max(0, time - before));
    try {
      taken(this.partOf(from, await this.source(from, Math.ceil(time + after))));
    } catch (error) {
      this.problem = message(error);
    }
    this.loading = false;
  }

  private partOf(from: number, { frames, until }: RecordedPoses): Part {
    const reader = new PoseFrames(this.scene.bodies.length);
    const part: Part = { times: [], poses: [], from, until: Math.max(until, from + before) };
    for (const [time, frame] of frames) {
      reader.take(frame);
      if (!reader.known) continue;
      part.times.push(time);
      const poses = reader.poses();
      part.poses.push(poses);
      this.paths.take(time, poses);
    }
    return part;
  }
}
