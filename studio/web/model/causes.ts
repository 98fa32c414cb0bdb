import type { SubsystemAtEnd, Verdict } from "./protocol";
import { withoutIndex, type Channel } from "./structure/structure";

/** The part of a verdict that is needed here. */
type Judged = Pick<
  Verdict,
  "name" | "verdict" | "why" | "hint" | "cut_off" | "warning" | "waits" | "at_end" | "behaviours" | "steps" | "narrative"
>;

/** An arrow of the chain of waiting: the waiting subsystem, the one it waits for, and the channel. */
export interface Wait {
  who: string;
  whom: string;
  channel: string;
  awaited: SubsystemAtEnd["awaited"];
}

/** The effects of one mistake of a system: the violations that it explains, and the stuck subsystems. */
export interface Cause {
  title: string;
  /** The violations, the one with a run to show first. */
  verdicts: Judged[];
  atEnd: readonly SubsystemAtEnd[];
  /** Behaviours that never run. */
  dead: readonly { path: string; line: number; included?: string }[];
  /** Only a warning: it needs a failure or the network to become a problem. */
  warning: boolean;
}

/** The subsystems that cannot go on, without those that go on or have ended. */
export const stuckIn = (atEnd: readonly SubsystemAtEnd[]) => [
  ...new Set(atEnd.filter(({ state }) => state === "waits" || state === "no_successor").map(({ path }) => path)),
];

export const waitsIn = (atEnd: readonly SubsystemAtEnd[]): Wait[] =>
  atEnd.flatMap(({ state, path, from, channel, awaited }) =>
    state === "waits" ? from.map((whom) => ({ who: path, whom, channel, awaited })) : [],
  );

/** All subsystems of the cause: the stuck ones, and those that they wait for. */
export const concernedIn = (atEnd: readonly SubsystemAtEnd[]) => [...new Set(atEnd.flatMap(({ path, from }) => [path, ...from]))];

/** The waits that form a circle; empty: there is no circle. */
export function circleIn(waits: readonly Wait[]): string[] {
  for (const { who } of waits) {
    const way: string[] = [];
    for (let at: string | undefined = who; at !== undefined && !way.includes(at); at = nextOf(waits, at)) way.push(at);
    if (nextOf(waits, way.at(-1)!) === who) return way;
  }
  return [];
}
const nextOf = (waits: readonly Wait[], who: string) => waits.find((one) => one.who === who)?.whom;

/** Describes the stuck subsystems and the reason, in one sentence. */
export function titleOf(atEnd: readonly SubsystemAtEnd[]): string {
  const circle = circleIn(waitsIn(atEnd));
  if (circle.length === 1) return `${circle[0]!} waits for itself`;
  if (circle.length > 1)
    return circle.length <= 3
      ? `${listed(circle)} wait for each other`
      : `${circle.length} subsystems wait for each other in a circle: ${listed(circle)}`;
  const lost = atEnd.find(({ state }) => state === "no_successor");
  if (lost) return `${lost.path} leaves ${lost.behaviour || "a behaviour"}, and nothing follows`;
  const ended = new Set(atEnd.filter(({ state }) => state === "ended").map(({ path }) => path));
  const left = waitsIn(atEnd).find(({ whom }) => ended.has(whom));
  if (left) return `${left.who} waits for ${left.whom}, which has ended`;
  const stuck = stuckIn(atEnd);
  if (stuck.length > 0) return `${listed(stuck)} ${stuck.length === 1 ? "gets" : "get"} stuck`;
  return atEnd[0]?.text ?? "";
}

const most = 4;
/** The behaviours in which subsystems stand still, by subsystem; as a run names those that are present. */
export const behavioursAt = (atEnd: readonly SubsystemAtEnd[]): ReadonlyMap<string, string> =>
  new Map(
    atEnd.flatMap(({ path, behaviour }) =>
      behaviour ? [[path, behaviour.startsWith(`${path}.`) ? behaviour.slice(path.length + 1) : behaviour] as const] : [],
    ),
  );

/** Names in one phrase: "a, b and c"; of many, the first ones. */
export const listed = (names: readonly string[]) =>
  names.length > most
    ? `${names.slice(0, most).join(", ")} and ${names.length - most} more`
    : names.length > 1
      ? `${names.slice(0, -1).join(", ")} and ${names.at(-1)!}`
      : names.join("");

const isViolated = ({ verdict }: Judged) => verdict === "violated";
const key = ({ path, channel, state }: SubsystemAtEnd) => `${state} ${path} ${channel}`;

type Ends = Pick<Channel, "from" | "to" | "send" | "receive" | "timeout">;
const subsystemOf = (path: string) => withoutIndex(path).split(".").slice(0, 2).join(".");

/** The stuck subsystems, and those that wait for them for ever, directly or not. */
function heldUp(stuck: readonly string[], channels: readonly Ends[]): ReadonlySet<string> {
  const held = new Set(stuck.map(subsystemOf));
  const waiting = channels.filter(({ timeout }) => !timeout);
  for (let before = -1; before < held.size;) {
    before = held.size;
    for (const { from, to, send, receive } of waiting) {
      const [sender, receiver] = [subsystemOf(from), subsystemOf(to)];
      if (receive === "blocking" && held.has(sender)) held.add(receiver);
      if (send === "blocking" && held.has(receiver)) held.add(sender);
    }
  }
  return held;
}

/**
 * Moves the dead behaviours of blocked subsystems to the cause that blocks them. A verdict that also has
 * others stays a cause of its own with these.
 */
function withDead(causes: Cause[], channels: readonly Ends[]): Cause[] {
  return causes.reduce<Cause[]>((all, cause) => {
    if (cause.warning || cause.atEnd.length > 0 || cause.dead.length === 0) return [...all, cause];
    let left = cause.dead;
    for (const other of all.filter(({ warning, atEnd }) => !warning && atEnd.length > 0)) {
      const held = heldUp(stuckIn(other.atEnd), channels);
      other.dead = [...other.dead, ...left.filter(({ path }) => held.has(subsystemOf(path)))];
      const rest = left.filter(({ path }) => !held.has(subsystemOf(path)));
      if (rest.length === 0) {
        other.verdicts = [...other.verdicts, ...cause.verdicts];
        return all;
      }
      left = rest;
    }
    return [...all, { ...cause, dead: left, title: deadTitle(left) }];
  }, []);
}

/**
 * Groups violations by their cause: those in which the same subsystem waits at the same channel have one
 * cause, and behaviours that never run have the cause that blocks their subsystem. Causes that are no
 * warnings come first.
 */
export function causesOf(verdicts: readonly Judged[], channels: readonly Ends[] = []): Cause[] {
  const causes: { verdicts: Judged[]; keys: Set<string>; warning: boolean }[] = [];
  // A violation that needs no failure explains more than one that does.
  const violated = verdicts.filter(isViolated).sort((a, b) => Number(a.warning) - Number(b.warning));
  for (const verdict of violated) {
    const keys = verdict.at_end.filter(({ state }) => state === "waits" || state === "no_successor").map(key);
    const same = causes.find((cause) => keys.length > 0 && keys.some((one) => cause.keys.has(one)));
    if (!same) causes.push({ verdicts: [verdict], keys: new Set(keys), warning: verdict.warning });
    else {
      same.verdicts.push(verdict);
      keys.forEach((one) => same.keys.add(one));
    }
  }
  const told = causes.map(({ verdicts: all, warning }) => {
    const telling = [...all].sort((a, b) => Number(b.at_end.length > 0) - Number(a.at_end.length > 0) || runOf(a) - runOf(b));
    const { at_end: atEnd } = telling[0]!;
    const dead = all.flatMap(({ behaviours }) => behaviours);
    return { title: titleOf(atEnd) || deadTitle(dead) || telling[0]!.why, verdicts: telling, atEnd, dead, warning };
  });
  // Stuck subsystems come before those that they block.
  const ordered = [...told.filter(({ atEnd }) => atEnd.length > 0), ...told.filter(({ atEnd }) => atEnd.length === 0)];
  return withDead(ordered, channels).sort((a, b) => Number(a.warning) - Number(b.warning));
}

/** Shorter runs are easier to follow; a missing run is the worst. */
const runOf = ({ steps }: Judged) => steps?.length ?? Infinity;

const deadTitle = (dead: Cause["dead"]) =>
  dead.length === 0 ? "" : dead.length === 1 ? `${dead[0]!.path} never runs` : `${dead.length} behaviours never run`;
