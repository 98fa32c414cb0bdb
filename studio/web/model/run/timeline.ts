import type { NetModel } from "../net/net";
import { bounded, count } from "../sorted";

/** The time at which a behaviour began; it ran until the next segment of its lane. */
export interface Segment {
  start: number;
  behaviour: string;
}

export interface Lane {
  path: string;
  subsystem: number;
  segments: Segment[];
  firings: number[];
  /** The times at which it called a transition function: the begin of each iteration. */
  calls: number[];
  /** Its behaviours, in the order of the specification. */
  behaviours: string[];
  /** The time from which all segments are kept. */
  since: number;
}

/** The names of the behaviours on a page, also of those in groups. */
const behaviourNames = (net: NetModel, page: number): string[] =>
  net
    .children(page)
    .flatMap((child) =>
      net.page(child).layer === "subsystem" ? behaviourNames(net, child) : (net.behaviourName(child) ?? net.page(child).name),
    );

/** The number of segments that are kept in an endless run. */
const most = 20_000;

/**
 * The running behaviour of each subsystem over time, and the times of its firings. Times in nanoseconds.
 */
export class Timeline {
  readonly lanes: Lane[];
  private readonly laneOf = new Map<number, number>();
  /** For transitions that have fired, the behaviour into which they put a token. */
  private readonly entered = new Map<number, string>();
  /** The same: whether they begin an iteration. */
  private readonly calling = new Map<number, boolean>();

  constructor(
    private readonly net: NetModel,
    private readonly limit = most,
  ) {
    this.lanes = net.subsystemPages().map((page, lane) => {
      const { path, subsystem } = net.page(page);
      if (subsystem !== null) this.laneOf.set(subsystem, lane);
      const behaviours = behaviourNames(net, page);
      return { path, subsystem: subsystem ?? -1, segments: [], firings: [], calls: [], behaviours, since: -Infinity };
    });
  }

  private enteredBy(transition: number): string {
    let known = this.entered.get(transition);
    if (known === undefined) {
      const pages = this.net.transitions.at(transition)!.outputs.map(({ place }) => this.net.places.at(place)!.page);
      known = pages.map((page) => this.net.behaviourName(page)).find(Boolean) ?? "";
      this.entered.set(transition, known);
    }
    return known;
  }

  private calls(transition: number): boolean {
    let known = this.calling.get(transition);
    if (known === undefined) {
      const { outputs } = this.net.transitions.at(transition)!;
      known = outputs.some(({ place }) => this.net.places.at(place)!.operation?.kind === "transition_function");
      this.calling.set(transition, known);
    }
    return known;
  }

  add(time: number, transition: number): void {
    const subsystem = this.net.transitions.at(transition)?.subsystem;
    const lane = subsystem === null || subsystem === undefined ? undefined : this.lanes[this.laneOf.get(subsystem) ?? -1];
    if (!lane) return;
    bounded(lane.firings, this.limit).push(time);
    if (this.calls(transition)) bounded(lane.calls, this.limit).push(time);
    this.enter(lane, time, this.enteredBy(transition));
  }

  /** The running behaviours at a time, by subsystem. Needed if firings are missing. Returns the lanes that this changes. */
  tell(time: number, running: ReadonlyMap<number, string>): Lane[] {
    return this.lanes.filter((lane) => this.enter(lane, time, running.get(lane.subsystem) ?? ""));
  }

  private enter(lane: Lane, time: number, behaviour: string): boolean {
    if ((lane.segments.at(-1)?.behaviour ?? "") === behaviour) return false;
    if (lane.segments.length >= this.limit) lane.since = bounded(lane.segments, this.limit)[0]!.start;
    lane.segments.push({ start: time, behaviour });
    return true;
  }

  /** The behaviour that ran at a time, "" for none; undefined: that is no longer known. */
  static behaviourAt(lane: Lane, time: number): string | undefined {
    if (time < lane.since) return undefined;
    return lane.segments[count(lane.segments, (one) => one.start <= time) - 1]?.behaviour ?? "";
  }

  /** Index of the first entry at or after a time. */
  static from(times: readonly number[], time: number): number {
    return count(times, (one) => one < time);
  }
}

/** A subsystem that runs different behaviours in two runs at the same time. */
export interface Difference {
  path: string;
  behaviours: readonly [string, string];
}

export function differences(one: Timeline, other: Timeline, time: number): Difference[] {
  return one.lanes.flatMap((lane) => {
    const twin = other.lanes.find(({ path }) => path === lane.path);
    if (!twin) return [];
    const behaviours = [Timeline.behaviourAt(lane, time), Timeline.behaviourAt(twin, time)] as const;
    if (behaviours[0] === undefined || behaviours[1] === undefined || behaviours[0] === behaviours[1]) return [];
    return [{ path: lane.path, behaviours: [behaviours[0], behaviours[1]] as const }];
  });
}
