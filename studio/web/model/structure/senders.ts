import { withoutIndex } from "./selection";
import { findThing, type Structure } from "./structure";

/** The subsystem whose values an input gets. */
export interface Sender {
  /** Without the number of a member of a fleet. */
  path: string;
  /** "5 Hz"; empty: the file does not say. */
  rate: string;
}

const subsystemOf = (path: string) => path.split(".").slice(0, 2).join(".");

/** The sender of the input that a value belongs to: "office.control" for carrier[0].control.wish.pause. */
export function senderOf(structure: Structure, path: string): Sender | undefined {
  const plain = withoutIndex(path);
  const channel = structure.channels.find(({ to }) => plain === withoutIndex(to) || plain.startsWith(`${withoutIndex(to)}.`));
  if (!channel) return undefined;
  const from = subsystemOf(withoutIndex(channel.from));
  const thing = findThing(structure, from);
  return thing?.kind === "subsystem" ? { path: from, rate: thing.of.rate } : undefined;
}
