/** Numbers over time, by path of the value: "robot.sensor.line.left". Times in nanoseconds. */
export interface Samples {
  times: number[];
  values: number[];
}

const most = 6000;

export class Series {
  readonly samples = new Map<string, Samples>();
  /** The last value of anything, numbers or not. */
  readonly latest = new Map<string, unknown>();

  add(time: number, path: string, value: unknown): void {
    if (typeof value === "number" || typeof value === "boolean") {
      this.latest.set(path, value);
      this.sample(time, path, Number(value));
    } else if (Array.isArray(value)) {
      if (value.length > 16) this.latest.set(path, `${value.length} values`);
      else value.forEach((one, at) => this.add(time, `${path}[${at}]`, one));
    } else if (value !== null && typeof value === "object") {
      for (const [key, one] of Object.entries(value)) this.add(time, `${path}.${key}`, one);
    } else if (value !== undefined && value !== null) {
      this.latest.set(path, value);
    }
  }

  private sample(time: number, path: string, value: number): void {
    const known = this.samples.get(path) ?? { times: [], values: [] };
    if (known.times.length === 0) this.samples.set(path, known);
    if (known.times.length >= most) {
      known.times.splice(0, most / 4);
      known.values.splice(0, most / 4);
    }
    known.times.push(time);
    known.values.push(value);
  }
}

/** 0.3, 12.5, 1.2e+7: short, and stable in width. */
export function shown(value: unknown): string {
  if (typeof value === "boolean") return value ? "true" : "false";
  if (typeof value !== "number") return String(value);
  if (Number.isInteger(value) && Math.abs(value) < 1e7) return String(value);
  return Math.abs(value) >= 1e5 || (value !== 0 && Math.abs(value) < 1e-3) ? value.toExponential(2) : value.toPrecision(4);
}
