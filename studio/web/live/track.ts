import type { NetModel } from "../model/net";
import { Series } from "../model/series";
import { bounded, count } from "../model/sorted";
import { Timeline } from "../model/timeline";
import type { Floor } from "./api";
import type { PathRow } from "./protocol";

export interface Pose {
  t: number;
  x: number;
  y: number;
  heading: number;
}

/** Of an endless run, as many poses as half an hour has. */
const most = 40_000;

let made = 0;

/** What a run left behind so far; read by what draws it, once per frame. */
export class Track {
  /** Another one for each. */
  readonly id = (made += 1);
  readonly timeline: Timeline;
  readonly series: Series;
  path: Pose[] = [];
  firings = 0;
  /** How many of the firings were only counted, because there were too many to be sent. */
  dropped = 0;
  /** The moment that is shown. */
  now = 0;
  /** Up to when it is known what fired. */
  known = 0;
  floor: Floor | null = null;

  /** `whole`: nothing of it is forgotten, for it has an end. */
  constructor(
    readonly net: NetModel,
    readonly whole = false,
  ) {
    this.timeline = whole ? new Timeline(net, Infinity) : new Timeline(net);
    this.series = whole ? new Series(Infinity) : new Series();
  }

  get end(): number {
    return Math.max(this.now, this.known);
  }

  /** A live run is shown as it is now. */
  reached(time: number): void {
    this.now = Math.max(this.now, time);
  }

  values(time: number, values: Readonly<Record<string, unknown>>): void {
    for (const [path, value] of Object.entries(values)) this.series.add(time, path, value);
  }

  pose(pose: Pose): void {
    bounded(this.path, most).push(pose);
  }

  /** The path up to some moment, as somebody else kept it; what came since stays. */
  pathUpTo(rows: readonly PathRow[]): void {
    if (rows.length === 0) return;
    const end = rows.at(-1)![0];
    const since = this.path.filter(({ t }) => t > end);
    this.path = [...rows.map(([t, x, y, heading]) => ({ t, x, y, heading })), ...since];
  }

  /** How much of the path lies before the moment that is shown. */
  get driven(): number {
    return count(this.path, ({ t }) => t <= this.now);
  }
}
