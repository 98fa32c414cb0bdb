import type { NetModel } from "./net";

/** From when a behaviour ran; until the next one of its lane. */
export interface Segment {
  start: number;
  behaviour: string;
}

export interface Lane {
  path: string;
  subsystem: number;
  segments: Segment[];
  firings: number[];
  /** Those that ran, in the order in which they first did. */
  behaviours: string[];
}

const most = 20_000;

/** Which behaviour of each subsystem ran when, and when its transitions fired. Times in nanoseconds. */
export class Timeline {
  readonly lanes: Lane[];
  first = Infinity;
  last = -Infinity;
  private readonly laneOf = new Map<number, number>();
  /** Per transition the lane, and the behaviour in which it puts a token. */
  private readonly entered: (string | null)[];

  constructor(net: NetModel) {
    this.lanes = net.subsystemPages().map((page, lane) => {
      const { path, subsystem } = net.page(page);
      if (subsystem !== null) this.laneOf.set(subsystem, lane);
      return { path, subsystem: subsystem ?? -1, segments: [], firings: [], behaviours: [] };
    });
    this.entered = net.transitions.map((transition) => {
      for (const arc of transition.outputs) {
        const place = net.places[arc.place]!;
        const behaviour = place.page === null ? null : net.behaviourOf(place.page);
        if (behaviour) return behaviour.name;
      }
      return null;
    });
    this.subsystems = net.transitions.map((transition) => transition.subsystem);
  }
  private readonly subsystems: (number | null)[];

  add(time: number, transition: number): void {
    this.first = Math.min(this.first, time);
    this.last = Math.max(this.last, time);
    const subsystem = this.subsystems[transition];
    const lane = subsystem === null || subsystem === undefined ? undefined : this.lanes[this.laneOf.get(subsystem) ?? -1];
    if (!lane) return;
    bounded(lane.firings).push(time);
    const behaviour = this.entered[transition] ?? "";
    if (lane.segments.at(-1)?.behaviour === behaviour) return;
    bounded(lane.segments).push({ start: time, behaviour });
    if (behaviour && !lane.behaviours.includes(behaviour)) lane.behaviours.push(behaviour);
  }

  /** Index of the first entry at or after a time. */
  static from(times: readonly number[], time: number): number {
    let [low, high] = [0, times.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (times[middle]! < time) low = middle + 1;
      else high = middle;
    }
    return low;
  }
}

function bounded<T>(list: T[]): T[] {
  if (list.length >= most) list.splice(0, most / 4);
  return list;
}
