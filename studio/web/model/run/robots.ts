import { perBody } from "./pose_frames";
import { bounded, count } from "../sorted";

/** A robot in a simulated world, or an object without an agent. */
export interface Robot {
  /** The name of its placed model, "robot[3]"; or of its agent or body. */
  name: string;
  /** Its agent; empty: none. */
  agent: string;
  /** The first of its bodies, which carries the others. */
  body: number;
}

/** The robots of a world, then the other objects. bodies: name and agent of each. */
export function robotsOf(bodies: readonly (readonly [string, string])[]): Robot[] {
  const found = new Map<string, Robot>();
  bodies.forEach(([body, agent], index) => {
    const slash = body.indexOf("/");
    const name = slash > 0 ? body.slice(0, slash) : agent || body;
    if (!found.has(name)) found.set(name, { name, agent, body: index });
  });
  const all = [...found.values()];
  return [...all.filter(({ agent }) => agent), ...all.filter(({ agent }) => !agent)];
}

/** A pose seen from above: metres, and the direction of its x axis in rad. */
export function fromAbove(poses: Float32Array, body: number): { x: number; y: number; heading: number } {
  const [x, y, , w, i, j, k] = poses.subarray(body * perBody, (body + 1) * perBody) as unknown as number[];
  return { x: x!, y: y!, heading: Math.atan2(2 * (w! * k! + i! * j!), 1 - 2 * (j! * j! + k! * k!)) };
}

/** Nanoseconds between two points of a path. */
const step = 100e6;
/** The number of points of all paths together; the oldest are dropped. */
const most = 400_000;

/** The paths of all robots, as far as their poses are known, in any order of time. */
export class Paths {
  readonly times: number[] = [];
  /** For each time: x and y of each robot. */
  readonly points: Float32Array[] = [];
  readonly robots: readonly Robot[];

  constructor(bodies: readonly (readonly [string, string])[]) {
    this.robots = robotsOf(bodies).filter(({ agent }) => agent);
  }

  take(time: number, poses: Float32Array): void {
    const { times, points, robots } = this;
    const at = count(times, (one) => one <= time);
    const isNear = (one: number | undefined) => one !== undefined && Math.abs(time - one) < step;
    if (robots.length === 0 || isNear(times[at - 1]) || isNear(times[at])) return;
    const point = new Float32Array(2 * robots.length);
    robots.forEach(({ body }, robot) => point.set(poses.subarray(body * perBody, body * perBody + 2), 2 * robot));
    if (at === times.length) {
      const room = Math.max(100, Math.floor(most / point.length));
      bounded(times, room).push(time);
      bounded(points, room).push(point);
    } else {
      times.splice(at, 0, time);
      points.splice(at, 0, point);
    }
  }
}
