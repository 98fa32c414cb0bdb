import { unitOf } from "../text/units";
import type { Structure } from "../structure/structure";

/** The part of a run that a signal shows. */
export type SignalKind =
  /** The value of a buffer, or of a field of memory. */
  | "value"
  /** The age of what an input holds. */
  | "age"
  /** New values of an input, per second. */
  | "rate"
  /** The behaviour that a subsystem runs. */
  | "behaviour";

export interface Signal {
  kind: SignalKind;
  /** "robot.control.line.left"; of a behaviour the path of its subsystem. */
  path: string;
}

/** The name of a signal: "age of robot.control.line". */
export const titleOf = ({ kind, path }: Signal): string => (kind === "value" ? path : `${kind} of ${path}`);
export const keyOf = ({ kind, path }: Signal): string => `${kind}:${path}`;
export const isSame = (one: Signal, other: Signal) => one.kind === other.kind && one.path === other.path;

export function unitOfSignal(structure: Structure, { kind, path }: Signal): string {
  if (kind === "age") return "s";
  if (kind === "rate") return "1/s";
  return kind === "value" ? unitOf(structure, path) : "";
}

const kinds: readonly string[] = ["value", "age", "rate", "behaviour"] satisfies SignalKind[];

/** A signal from text that was kept or dragged; null: it is none. */
export function signalOf(given: unknown): Signal | null {
  const { kind, path } = (given ?? {}) as Partial<Signal>;
  return typeof path === "string" && path !== "" && typeof kind === "string" && kinds.includes(kind)
    ? { kind: kind as SignalKind, path }
    : null;
}

/** A picture with the axes of one or two units. */
export interface Chart<One> {
  /** The unit of the left axis; empty: numbers without a unit. */
  left: string;
  /** null: there is no axis on the right. */
  right: string | null;
  signals: readonly One[];
}

/** One chart for the first two units, its left and its right axis; one below for each further unit. */
export function chartsOf<One extends { unit: string }>(signals: readonly One[]): Chart<One>[] {
  const units = [...new Set(signals.map(({ unit }) => unit))];
  const of = (...wanted: string[]) => signals.filter(({ unit }) => wanted.includes(unit));
  if (units.length === 0) return [];
  const [first = "", second] = units;
  return [
    { left: first, right: second ?? null, signals: of(first, ...(second === undefined ? [] : [second])) },
    ...units.slice(2).map((unit) => ({ left: unit, right: null, signals: of(unit) })),
  ];
}
