import { removeBehaviour, setChannel, setField } from "./edits";
import type { Cause } from "../causes";
import { findThing, readStructure, withoutIndex, type Channel, type Structure } from "../structure/structure";
import { addNext } from "./next_edits";

/** An edit that may mend a cause. The verification decides whether it does. */
export interface Candidate {
  title: string;
  /** Its effect on the robot. */
  meaning: string;
  text: string;
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
      return channel && one.awaited !== "memory" ? atChannel(structure, channel, sends) : [];
    }),
    // Blocked behaviours run again once no subsystem is stuck.
    ...(cause.atEnd.length > 0 ? [] : cause.dead.flatMap(({ path }) => withoutBehaviour(structure, path))),
  ];
  const different = all.filter(
    ({ text }, at) => text !== structure.yaml.text && all.findIndex((other) => other.text === text) === at,
  );
  // Timeouts first: they change least.
  return different.sort((a, b) => rank(a) - rank(b)).slice(0, most);
}

const rank = ({ title }: Candidate) => (title.startsWith("Let") ? 1 : title.startsWith("Remove") ? 2 : 0);

/** The channel of the specification that a channel of the net was made from: "a[2].x.y->b[3].z.u". */
export function channelOf(structure: Structure, name: string): Channel | undefined {
  const [from = "", to = ""] = name.split("->").map(withoutIndex);
  return structure.channels.find((one) => withoutIndex(one.from) === from && withoutIndex(one.to) === to);
}

function atChannel(structure: Structure, channel: Channel, sends: boolean): Candidate[] {
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
      text: setField(structure, at, key, timeout),
    },
    {
      title: `Let ${who} go on at once`,
      meaning: `The ${side} no longer waits ${what}.`,
      text: withoutTimeout(
        setChannel(structure, channel, sends ? { send: "non_blocking" } : { receive: "non_blocking" }),
        channel,
      ),
    },
  ];
}

/** A side that does not wait has no timeout. */
function withoutTimeout(text: string, channel: Channel): string {
  const structure = readStructure(text);
  const now = structure.channels[channel.index];
  const waits = now && (now.send === "blocking" || now.receive === "blocking");
  return waits ? text : setField(structure, ["channels", channel.index], "timeout", "");
}

/** A successor where there is none: the behaviour again, or the first one of the subsystem. */
function followers(structure: Structure, path: string, name: string): Candidate[] {
  const thing = findThing(structure, `${path}.${name}`);
  if (thing?.kind !== "behaviour") return [];
  const { of, subsystem } = thing;
  const start = subsystem.start || subsystem.behaviours[0]!.name;
  return [...new Set([start, of.name])].map((to) => ({
    title: to === name ? `Otherwise, repeat ${name}` : `Otherwise, go on to ${to}`,
    meaning: `After ${name}, if no other condition holds, ${to} follows in ${withoutIndex(path)}.`,
    text: addNext(structure, of, { to, when: "" }),
  }));
}

function withoutBehaviour(structure: Structure, path: string): Candidate[] {
  const thing = findThing(structure, path);
  if (thing?.kind !== "behaviour") return [];
  return [
    {
      title: `Remove ${withoutIndex(path)}`,
      meaning: "The behaviour never runs, so the system does the same without it.",
      text: removeBehaviour(structure, thing.subsystem, thing.of, readStructure),
    },
  ];
}
