import type { NetModel } from "../net/net";
import type { FiringRow } from "../protocol";
import { bounded } from "../sorted";
import { sentenceOf, Teller, type Ending, type Words } from "./words";

export const eventKinds = {
  behaviour: "Behaviours",
  failure: "Failures",
  timeout: "Timeouts",
  fault: "Faults",
  overrun: "Overruns",
  device: "Safe commands",
  message: "Messages",
  parameter: "Parameters",
  operator: "Commands",
  emergency: "Emergency stops",
  run: "The run",
} as const;
export type EventKind = keyof typeof eventKinds;

/** An entry of the log that is no step within a behaviour. */
export interface LogEvent {
  /** Nanoseconds of the run's clock. */
  t: number;
  kind: EventKind;
  /** The path of a subsystem or agent; empty: the system. */
  who: string;
  /** Without `who`; empty: the words of the firing say it. */
  text: string;
  level?: "warning" | "error";
  /** The firing, and what ended the behaviour before. */
  firing?: { transition: number; ending: Ending };
}

/** An entry of the log as it is shown. */
export interface LogRow {
  t: number;
  kind: EventKind | "firing";
  who: string;
  text: string;
  /** The path to select; empty: none. */
  place: string;
  level: "info" | "warning" | "error";
  words: Words | null;
}

/** The runtime begins with these words when subsystems wait for each other for ever (watch/stuck.cpp). */
export const stuckText = "stuck for good";

/** The number of events, and of firings, that are kept of an endless run. */
export const mostEvents = 100_000;

/** The events of a run in the order of time: firings, and notices of the controller, the page and the operator. */
export class EventLog {
  readonly teller: Teller;
  /** All but the steps within behaviours. */
  readonly events: LogEvent[] = [];
  /** The firings, one by one. */
  readonly firings: FiringRow[] = [];
  /** The numbers of those that were too old to be kept. */
  lost = { events: 0, firings: 0, notices: 0 };
  /** The runtime has found that subsystems wait for each other for ever. */
  stuck: LogEvent | null = null;
  /** Another number after each change. */
  version = 0;
  /** By subsystem, the last firing that ended an iteration as terminal or by an error. */
  private readonly endings = new Map<number, number>();

  /** whole: nothing is dropped, because the run has an end. */
  constructor(
    private readonly net: NetModel,
    private readonly most = mostEvents,
  ) {
    this.teller = new Teller(net);
  }

  /** The last firing; null: none is known. */
  get last(): FiringRow | null {
    return this.firings.at(-1) ?? null;
  }

  fired(row: FiringRow): void {
    const [t, transition] = row;
    const subsystem = this.net.transitions.at(transition)?.subsystem ?? -1;
    this.lost.firings += cut(this.firings, this.most);
    this.firings.push(row);
    const { kind } = this.teller.words(transition);
    this.version += 1;
    const ending = kind === "change" ? (this.endings.get(subsystem) ?? null) : null;
    // Several entries of `next` may follow one end: out of the groups around the behaviour.
    if (this.teller.ends(transition)) this.endings.set(subsystem, transition);
    else if (kind !== "change") this.endings.delete(subsystem);
    if (kind === "step") return;
    const { who } = this.teller.words(transition, ending);
    this.insert({ t, kind: kind === "change" ? "behaviour" : kind, who, text: "", firing: { transition, ending } });
  }

  /** Adds what is no firing. It may be a little older than what is there. */
  add(event: LogEvent): void {
    this.insert(event);
    this.version += 1;
  }

  /** Adds those that are not there already: they may be asked for, and reported as well. */
  addOnce(events: readonly LogEvent[]): void {
    const first = events.reduce((least, { t }) => Math.min(least, t), Infinity);
    const known = new Set<string>();
    for (let at = this.events.length - 1; at >= 0 && this.events[at]!.t >= first; at -= 1) known.add(keyOf(this.events[at]!));
    const fresh = events.filter((event) => !known.has(keyOf(event)));
    for (const event of fresh) if (event.kind === "message" && event.text.startsWith(stuckText)) this.stuck = event;
    if (fresh.length <= few) return fresh.forEach((event) => this.add(event));
    this.lost.events += cut(this.events, this.most);
    this.events.push(...fresh);
    this.events.sort((one, other) => one.t - other.t);
    this.version += 1;
  }

  /** The events up to a time whose firing changed a behaviour, failed or timed out: the last of them; null: none. */
  lastTold(time: number): LogEvent | null {
    for (let at = this.events.length - 1; at >= 0; at -= 1) {
      const event = this.events[at]!;
      if (event.t <= time && event.firing && event.kind !== "timeout") return event;
    }
    return null;
  }

  row(entry: LogEvent | FiringRow): LogRow {
    if (!("kind" in entry)) {
      const words = this.teller.words(entry[1]);
      return { t: entry[0], kind: "firing", who: words.who, text: textOf(words), place: words.place, level: "info", words };
    }
    const { t, kind, who, text, firing, level = kind === "failure" || kind === "emergency" ? "error" : "info" } = entry;
    if (!firing) return { t, kind, who, text, place: who, level, words: null };
    const words = this.teller.words(firing.transition, firing.ending);
    return { t, kind, who, text: text || textOf(words), place: words.place, level, words };
  }

  private insert(event: LogEvent): void {
    this.lost.events += cut(this.events, this.most);
    let at = this.events.length;
    while (at > 0 && this.events[at - 1]!.t > event.t) at -= 1;
    this.events.splice(at, 0, event);
  }
}

/** So many events are put at their places one by one. */
const few = 20;

const keyOf = ({ t, kind, who, text }: LogEvent) => `${t} ${kind} ${who} ${text}`;

/** The words without the one who acts. */
const textOf = (words: Words) => sentenceOf({ ...words, who: "" }).replace(/^the system /, "");

/** Cuts the oldest entries of a list that has `most`; returns their number. */
function cut(list: unknown[], most: number): number {
  const before = list.length;
  bounded(list, most);
  return before - list.length;
}

/** The entries that the log shows. */
export interface LogFilter {
  kinds: ReadonlySet<EventKind>;
  /** Each firing, not only those that change a behaviour. */
  firings: boolean;
  /** An agent or a subsystem; empty: all. */
  of: string;
  /** A part of the text, in small letters; empty: any. */
  text: string;
}

/** The entries that pass a filter, in the order of time. */
export function filtered(log: EventLog, filter: LogFilter): (LogEvent | FiringRow)[] {
  const isOf = (who: string) =>
    !filter.of || who === filter.of || who.startsWith(`${filter.of}.`) || who.startsWith(`${filter.of}[`);
  const has = (who: string, text: string) => !filter.text || `${who || "the system"} ${text}`.toLowerCase().includes(filter.text);
  const passes = (event: LogEvent) => {
    if (!filter.kinds.has(event.kind) || !isOf(event.who)) return false;
    return !filter.text || has(event.who, log.row(event).text);
  };
  const events = log.events.filter(passes);
  if (!filter.firings) return events;
  const known = new Map<number, boolean>();
  const steps = log.firings.filter((row) => {
    let is = known.get(row[1]);
    if (is === undefined) {
      const words = log.teller.words(row[1]);
      // The others are among the events.
      is = words.kind === "step" && isOf(words.who) && has(words.who, textOf(words));
      known.set(row[1], is);
    }
    return is;
  });
  return merged(events, steps);
}

function merged(events: readonly LogEvent[], steps: readonly FiringRow[]): (LogEvent | FiringRow)[] {
  const all: (LogEvent | FiringRow)[] = [];
  let next = 0;
  for (const event of events) {
    while (next < steps.length && steps[next]![0] <= event.t) all.push(steps[next++]!);
    all.push(event);
  }
  while (next < steps.length) all.push(steps[next++]!);
  return all;
}
