import type { Edit } from "../protocol";
import { channelEnd, fleetOf, isForEach } from "../structure/connections";
import { findThing, type Buffer, type Structure } from "../structure/structure";
import { connect, set } from "./edits";
import { typeParts, typeText } from "./type_text";

/** The type with an element for each member of a fleet; undefined: the text is no type of one value. */
function forEach(fleet: string, type: string): string | undefined {
  const parts = typeParts(type);
  return parts && !parts.length ? typeText({ ...parts, length: `each ${fleet}` }) : undefined;
}

/**
 * Edits that connect an output with an input. An input has one source, so an input of a single agent becomes an array if a
 * fleet sends to it: one element for each member.
 */
export function connectEdits(structure: Structure, output: string, input: string): Edit[] {
  const [from, to] = [output, input].map((path) => channelEnd(structure, path)) as [string, string];
  const bufferAt = (path: string, direction: Buffer["direction"]) => {
    const found = findThing(structure, `${direction}:${path}`);
    return found?.kind === "buffer" ? found.of : undefined;
  };
  const senders = fleetOf(structure, output, input);
  if (senders !== undefined) {
    const reader = bufferAt(input, "input");
    if (!reader || isForEach(senders, reader.type)) return [connect(from, `${to}[i]`)];
    const type = forEach(senders, reader.type);
    if (type === undefined) return [connect(from, to)];
    return [set(reader.yaml.slice(0, -1), String(reader.yaml.at(-1)), type), connect(from, `${to}[i]`)];
  }
  const readers = fleetOf(structure, input, output);
  const writer = readers !== undefined && bufferAt(output, "output");
  return [connect(writer && isForEach(readers, writer.type) ? `${from}[i]` : from, to)];
}
