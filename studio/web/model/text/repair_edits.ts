import type { Cause } from "../causes";
import { channelOf, findThing, targetsIn, withoutIndex, type Channel, type Structure } from "../structure/structure";
import type { Edit } from "../protocol";
import { addNext, remove, set, setChannel } from "./edits";

/** An edit that may mend a cause. The verification decides whether it does. */
export interface Candidate {
  title: string;
  /** Its effect on the robot. */
  meaning: string;
  edits: Edit[];
}

/** The number that can be verified while the user waits. */
const most = 10;
const timeout = "1 s";

export function candidatesFor(cause: Cause, structure: Structure): Candidate[] {
  const all = [
    ...cause.atEnd.flatMap((one): Candidate[] => {
      if (one.state === "no_successor") return followers(structure, one.path, one.behaviour);
      const channel = one.state === "waits" ? channelOf(structure, one.channel) : undefined;
      const sends = one.awaited === "acknowledgement";
      return channel && one.awaited !== "memory" ? atChannel(channel, sends) : [];
    }),
    // Blocked behaviours run again once no subsystem is stuck.
    ...(cause.atEnd.length > 0 ? [] : cause.dead.flatMap(({ path }) => withoutBehaviour(structure, path))),
  ];
  const same = (one: Candidate, other: Candidate) => JSON.stringify(one.edits) === JSON.stringify(other.edits);
  const different = all.filter((one, at) => all.findIndex((other) => same(one, other)) === at);
  // Timeouts first: they change least.
  return different.sort((a, b) => rank(a) - rank(b)).slice(0, most);
}

const rank = ({ title }: Candidate) => (title.startsWith("Let") ? 1 : title.startsWith("Remove") ? 2 : 0);

function atChannel(channel: Channel, sends: boolean): Candidate[] {
  if (channel.model) return [];
  const side = sends ? "sender" : "receiver";
  const who = withoutIndex(sends ? channel.from : channel.to);
  const both = channel.send === "blocking" && channel.receive === "blocking";
  const at = ["channels", channel.index];
  const key = both ? (sends ? "send_timeout" : "receive_timeout") : "timeout";
  const what = sends ? "for the acknowledgement" : "for a value";
  return [
    {
      title: `Give up waiting at ${who} after ${timeout}`,
      meaning: `The ${side} waits ${what} for ${timeout} at most, and then goes on without it.`,
      edits: [set(at, key, timeout)],
    },
    {
      title: `Let ${who} go on at once`,
      meaning: `The ${side} no longer waits ${what}.`,
      edits: [
        setChannel(channel, sends ? { send: "non_blocking" } : { receive: "non_blocking" }),
        // A side that does not wait has no timeout.
        ...(both || !channel.timeout ? [] : [set(at, "timeout", "")]),
      ],
    },
  ];
}

/** A successor where there is none: the behaviour again, or the first one of the subsystem. */
function followers(structure: Structure, path: string, name: string): Candidate[] {
  const thing = findThing(structure, `${path}.${name}`);
  if (thing?.kind !== "behaviour") return [];
  const { of, subsystem } = thing;
  const group = subsystem.behaviours.find((one) => one.path === of.group);
  const given = group ? structure.yaml.valueText([...group.yaml, "start"]) : subsystem.start;
  // One of those for each member of a fleet goes on by itself: its index is i there.
  const own = of.for ? `${of.name}[i]` : of.name;
  const first = targetsIn(subsystem, of.group)[0]!;
  const start = given || (withoutIndex(first) === of.name ? own : first);
  return [...new Set([start, own])].map((to) => ({
    title: to === own ? `Otherwise, repeat ${of.for ? own : name}` : `Otherwise, go on to ${to}`,
    meaning: `After ${of.for ? own : name}, if no other condition holds, ${to} follows in ${withoutIndex(path)}.`,
    edits: [addNext(of, { to, when: "" })],
  }));
}

function withoutBehaviour(structure: Structure, path: string): Candidate[] {
  const thing = findThing(structure, path);
  if (thing?.kind !== "behaviour") return [];
  return [
    {
      title: `Remove ${withoutIndex(path)}`,
      meaning: "The behaviour never runs, so the system does the same without it.",
      edits: [remove(thing.of.yaml)],
    },
  ];
}
