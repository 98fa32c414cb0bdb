import type { NetModel } from "../../model/net/net";
import { EventLog } from "../../model/run/event_log";
import { Series } from "../../model/run/series";
import { bounded, count } from "../../model/sorted";
import { Timeline } from "../../model/run/timeline";
import type { Floor } from "../api";
import { ArrivalLog } from "../../model/plots/arrivals";
import type { Arrival, FiringRow, PathRow } from "../../model/protocol";
import { LiveArrays, type Arrays } from "../arrays";
import type { World } from "../world";

export interface Pose {
  t: number;
  x: number;
  y: number;
  heading: number;
}

/** For an endless run, the poses of half an hour. */
const most = 40_000;

let made = 0;

/** The recorded data of a run so far. The drawing reads it once per frame. */
export class Track {
  /** A different number for each track. */
  readonly id = (made += 1);
  readonly timeline: Timeline;
  readonly series: Series;
  /** When the inputs got new values of their senders, by path of the input. */
  readonly arrivals: ArrivalLog;
  readonly log: EventLog;
  path: Pose[] = [];
  /** All firings so far. */
  firings = 0;
  /** The firings that arrived one by one. */
  listed = 0;
  /** The shown time. */
  now = 0;
  /** The time up to which the firings are known. */
  known = 0;
  floor: Floor | null = null;
  /** The simulated world; null: there is none, or it is not known yet. */
  world: World | null = null;
  /** Scans and pictures. */
  arrays: Arrays = new LiveArrays();

  /** whole: nothing is discarded, because the run has an end. */
  constructor(
    readonly net: NetModel,
    readonly whole = false,
  ) {
    this.timeline = whole ? new Timeline(net, Infinity) : new Timeline(net);
    this.series = whole ? new Series(Infinity) : new Series();
    this.arrivals = whole ? new ArrivalLog(Infinity) : new ArrivalLog();
    this.log = whole ? new EventLog(net, Infinity) : new EventLog(net);
  }

  /** The number of firings that are only counted: there were too many to send, or no page was connected. */
  get dropped(): number {
    return Math.max(0, this.firings - this.listed);
  }

  get end(): number {
    return Math.max(this.now, this.known);
  }

  fired(row: FiringRow): void {
    this.timeline.add(row[0], row[1]);
    this.log.fired(row);
  }

  /** The running behaviours at a time, by subsystem. Needed if firings are missing. */
  tell(time: number, running: ReadonlyMap<number, string>): void {
    for (const { path, segments } of this.timeline.tell(time, running)) {
      const { behaviour } = segments.at(-1)!;
      if (behaviour) this.log.add({ t: time, kind: "behaviour", who: path, text: `is in ${behaviour}` });
    }
  }

  /** A live run is shown at its current time. */
  reached(time: number): void {
    this.now = Math.max(this.now, time);
  }

  values(time: number, values: Readonly<Record<string, unknown>>): void {
    for (const [path, value] of Object.entries(values)) this.series.add(time, path, value);
  }

  /** New values came through channels. An input whose last value is not valid has a gap. dropped: some are not listed. */
  arrived(arrivals: Readonly<Record<string, readonly Arrival[]>>, dropped = 0): void {
    if (dropped > 0) this.arrivals.interrupt(this.now);
    for (const [path, rows] of Object.entries(arrivals))
      for (const [time, written, valid] of rows) {
        // An input that nobody has sent to yet is read again and again.
        if (!valid && this.arrivals.isInvalid(path)) continue;
        if (!valid) this.series.lose(time, path);
        else if (this.arrivals.isInvalid(path)) this.series.regain(time, path);
        this.arrivals.add(path, time, written, valid);
      }
  }

  pose(pose: Pose): void {
    bounded(this.path, most).push(pose);
  }

  /** The path up to a time, from the server; later poses stay. */
  pathUpTo(rows: readonly PathRow[]): void {
    if (rows.length === 0) return;
    const end = rows.at(-1)![0];
    const since = this.path.filter(({ t }) => t > end);
    this.path = [...rows.map(([t, x, y, heading]) => ({ t, x, y, heading })), ...since];
  }

  /** The number of poses up to the shown time. */
  get driven(): number {
    return count(this.path, ({ t }) => t <= this.now);
  }
}
