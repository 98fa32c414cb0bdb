import { bounded, count } from "../sorted";

/** A value over time. Times in nanoseconds. */
export interface Samples<T = number> {
  times: number[];
  values: T[];
}

/** The number of samples that are kept in an endless run. */
const most = 6000;

/** Values over time, by path: "robot.sensor.line.left". A value holds until the next one. */
export class Series {
  /** Numbers; true is 1 and false is 0. */
  readonly samples = new Map<string, Samples>();
  private readonly all = new Map<string, Samples<unknown>>();

  constructor(private readonly limit = most) {}

  get paths(): string[] {
    return [...this.all.keys()].sort();
  }

  /** Adds changed values; the others stay as they were. */
  add(time: number, path: string, value: unknown): void {
    if (Array.isArray(value)) {
      if (value.length > 16) this.sample(this.all, time, path, `${value.length} values`);
      else value.forEach((one, at) => this.add(time, `${path}[${at}]`, one));
    } else if (value !== null && typeof value === "object") {
      for (const [key, one] of Object.entries(value)) this.add(time, `${path}.${key}`, one);
    } else if (value !== undefined && value !== null) {
      this.sample(this.all, time, path, value);
      if (typeof value === "number" || typeof value === "boolean") this.sample(this.samples, time, path, Number(value));
    }
  }

  /** The value at a time; undefined before the first one. */
  at(path: string, time: number): unknown {
    const { times, values } = this.all.get(path) ?? { times: [], values: [] };
    return values[count(times, (one) => one <= time) - 1];
  }

  private sample<T>(to: Map<string, Samples<T>>, time: number, path: string, value: T): void {
    let known = to.get(path);
    if (!known) to.set(path, (known = { times: [], values: [] }));
    bounded(known.times, this.limit).push(time);
    bounded(known.values, this.limit).push(value);
  }
}

/** 0.3, 12.5, 1.2e+7: short, and of constant width. */
export function shown(value: unknown): string {
  if (value === undefined) return "";
  if (typeof value === "boolean") return value ? "true" : "false";
  if (typeof value !== "number") return String(value);
  if (Number.isInteger(value) && Math.abs(value) < 1e7) return String(value);
  return Math.abs(value) >= 1e5 || (value !== 0 && Math.abs(value) < 1e-3) ? value.toExponential(2) : value.toPrecision(4);
}
