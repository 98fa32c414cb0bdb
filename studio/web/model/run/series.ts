import { bounded, count } from "../sorted";

/** A value over time. Times in nanoseconds. */
export interface Samples<T = number> {
  times: number[];
  values: T[];
}

/** The number of samples that are kept in an endless run. */
const most = 6000;

/** The texts that stand for numbers that JSON does not have. */
const notFinite = /^[-+]?(nan|inf)/i;

/** Values over time, by path: "robot.sensor.line.left". A value holds until the next one. */
export class Series {
  /** Numbers; true is 1 and false is 0. NaN: there is no valid value until the next one. */
  readonly samples = new Map<string, Samples>();
  /** Paths whose values are true and false. */
  readonly booleans = new Set<string>();
  private readonly all = new Map<string, Samples<unknown>>();
  /** The number of samples so far, also of those that are not kept. */
  size = 0;

  private sorted: readonly string[] = [];

  constructor(private readonly limit = most) {}

  get paths(): readonly string[] {
    // A fleet has thousands, and no path ever goes.
    if (this.sorted.length !== this.all.size) this.sorted = [...this.all.keys()].sort();
    return this.sorted;
  }

  /** All values over time, texts too; undefined: there is no valid value. */
  values(path: string): Samples<unknown> | undefined {
    return this.all.get(path);
  }

  /** Whether it has texts, such as the names of states. */
  isText(path: string): boolean {
    return !this.samples.has(path) && this.all.has(path);
  }

  /** A buffer and all values in it have no valid value from then on. */
  lose(time: number, buffer: string): void {
    for (const path of this.within(buffer)) {
      const known = this.all.get(path)!;
      if (known.values.at(-1) === undefined) continue;
      this.sample(this.all, time, path, undefined);
      if (this.samples.has(path)) this.sample(this.samples, time, path, NaN);
    }
  }

  /** The buffer has its last valid value again. */
  regain(time: number, buffer: string): void {
    for (const path of this.within(buffer)) {
      const { values } = this.all.get(path)!;
      if (values.at(-1) === undefined && values.length > 1) this.add(time, path, values.at(-2));
    }
  }

  private within(buffer: string): string[] {
    return [...this.all.keys()].filter(
      (path) => path === buffer || path.startsWith(`${buffer}.`) || path.startsWith(`${buffer}[`),
    );
  }

  /** Adds changed values; the others stay as they were. null: there is none any more. */
  add(time: number, path: string, value: unknown): void {
    if (Array.isArray(value)) {
      if (value.length > 16) this.sample(this.all, time, path, `${value.length} values`);
      else value.forEach((one, at) => this.add(time, `${path}[${at}]`, one));
    } else if (value !== null && typeof value === "object") {
      for (const [key, one] of Object.entries(value)) this.add(time, `${path}.${key}`, one);
    } else if (value === null) this.lose(time, path);
    else if (value !== undefined) {
      this.sample(this.all, time, path, value);
      if (typeof value === "boolean") this.booleans.add(path);
      if (typeof value === "number" || typeof value === "boolean") this.sample(this.samples, time, path, Number(value));
      else if (typeof value === "string" && notFinite.test(value)) this.sample(this.samples, time, path, NaN);
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
    this.size += 1;
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
