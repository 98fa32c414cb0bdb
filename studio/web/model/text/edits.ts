import type { Edit, EditValue, PlacedText, TextPosition } from "../protocol";
import type { Agent, Behaviour, Buffer, Channel, Subsystem, SubsystemKind } from "../structure/structure";
import { lineStarts } from "./line_ends";
import { diff } from "./merge";
import type { YamlPath, YamlText } from "./yaml_text";

/** Edits that the server does (`POST /api/edit`). */

/** `name`, with a number if it is taken. */
export function freeName(name: string, taken: readonly string[]): string {
  if (!taken.includes(name)) return name;
  for (let number = 2; ; number += 1) if (!taken.includes(`${name}_${number}`)) return `${name}_${number}`;
}

export const isName = (name: string) => /^[A-Za-z](?:_?[A-Za-z0-9])*$/.test(name) && name.length <= 64;

/** The text after edits that do not overlap. */
export function applied(text: string, edits: readonly PlacedText[]): string {
  const starts = lineStarts(text);
  const offset = ({ line, character }: TextPosition) => (starts[line] ?? text.length) + character;
  return edits
    .map(({ from, to, text: insert }) => ({ from: offset(from), to: offset(to), insert }))
    .sort((a, b) => b.from - a.from || b.to - a.to)
    .reduce((now, { from, to, insert }) => now.slice(0, from) + insert + now.slice(to), text);
}

/** A place in the specification. */
export type At = readonly (string | number)[];
const path = (at: At) => [...at];

export const set = (at: At, key: string, text: string, as: NonNullable<Edit["as"]> = "scalar"): Edit => ({
  do: "set",
  at: path(at),
  key,
  text,
  as,
});
export const insert = (at: At, key: string, value: EditValue): Edit => ({
  do: "insert",
  at: path(at),
  key,
  value,
});
export const append = (at: At, value: EditValue): Edit => ({ do: "append", at: path(at), value });
export const replace = (at: At, value: EditValue): Edit => ({ do: "replace", at: path(at), value });
/** Also removes what cannot be without it. */
export const remove = (at: At): Edit => ({ do: "remove", at: path(at) });
/** Gives it another name wherever it is used, also in C++ and params.yaml. */
export const rename = (at: At, name: string): Edit => ({ do: "rename", at: path(at), text: name });
/** A path that was known before the rename of an element was done. */
export function pathAfter({ at: from = [], text: name = "" }: Edit, at: At): At {
  const isInside = at.length >= from.length && from.every((step, index) => step === at[index]);
  return isInside ? at.map((step, index) => (index === from.length - 1 ? name : step)) : at;
}

/** Texts of the items of a list. */
const itemsAt = (yaml: YamlText, at: At) => (yaml.seq(at)?.items ?? []).map((_, index) => yaml.valueText([...at, index]) ?? "");

/** The number of an item after others were removed, added or put back; undefined: it is gone itself. */
function numberNow(index: number, before: readonly string[], after: readonly string[]): number | undefined {
  let now = index;
  for (const { from, to, lines } of before.length > 0 ? diff(before, after) : []) {
    if (to <= index) now += lines.length - (to - from);
    else if (from <= index && lines.length < to - from) return undefined;
  }
  return now;
}

/**
 * The path, in the text `now`, of an element that stood at a path of the text `before`. renamed: its path with the names that
 * were given since then.
 */
export function pathNow(at: At, renamed: (at: At) => At, before: YamlText, now: YamlText): YamlPath {
  const found = [...renamed(at)];
  if (before !== now)
    at.forEach((step, index) => {
      if (typeof step !== "number") return;
      const number = numberNow(step, itemsAt(before, at.slice(0, index)), itemsAt(now, found.slice(0, index)));
      if (number === undefined) throw new Error("it is not there any more");
      found[index] = number;
    });
  return found;
}

/** An edit with the paths that elements have now. */
export function moved({ at = [], key, ...edit }: Edit, now: (at: At) => At): Edit {
  const number = edit.do === "next" && key !== undefined ? Number(key) : undefined;
  const last = edit.do === "set" && key !== undefined ? now([...at, key]).at(-1) : undefined;
  const next = number === undefined ? undefined : now([...at, "next", number]).at(-1);
  const present = last ?? next ?? key;
  return { ...edit, at: [...now(at)], ...(present === undefined ? {} : { key: String(present) }) };
}

/** A copy of an element behind it, with its comments; with an agent, also the channels within it. */
export const copyOf = (at: At, name: string): Edit => ({ do: "copy", at: path(at), key: name });
/** Adds the one entry of a text to a map, with the comments above it, under a name. */
export const paste = (map: At, name: string, text: string): Edit => ({ do: "paste", at: path(map), key: name, text });

export const makeTemplate = (agent: Agent): Edit => ({ do: "make_template", at: path(agent.yaml) });

const fresh = (rate: string) => ({ rate, behaviours: { run: "{}" } });
export const freshAgent = { control: fresh("10 Hz") };

export const addSubsystem = (agent: Agent, kind: SubsystemKind, name: string): Edit =>
  insert(kind === "control" ? agent.body : [...agent.body, `${kind}s`], kind === "control" ? kind : name, fresh("50 Hz"));
/** of: the subsystem or the group. */
export const addBehaviour = (of: { yaml: At }, name: string): Edit => insert([...of.yaml, "behaviours"], name, "{}");
export const addGroup = (of: { yaml: At }, name: string): Edit =>
  insert([...of.yaml, "behaviours"], name, { behaviours: { act: "{}" } });
/** Moves a behaviour to a group, by its path in the subsystem: "charge.dock"; empty: out of all groups. */
export const moveTo = (behaviour: Behaviour, group: string): Edit => ({ do: "move", at: path(behaviour.yaml), text: group });

const bufferKey = { input: "inputs", output: "outputs", real: "real" } as const;
export const addBuffer = (subsystem: Subsystem, direction: Buffer["direction"], name: string, type: string): Edit =>
  insert([...subsystem.yaml, bufferKey[direction]], name, type);

export interface ChannelFields {
  send: Channel["send"];
  receive: Channel["receive"];
  timeout: string;
  model: string;
}

export const connect = (from: string, to: string): Edit => ({ do: "connect", at: ["channels"], fields: { from, to } });
export const setChannel = ({ index }: Channel, fields: Partial<ChannelFields>): Edit => ({
  do: "channel",
  at: ["channels", index],
  fields,
});

export const addNext = (behaviour: Behaviour, fields: Partial<Behaviour["next"][number]>): Edit => ({
  do: "next",
  at: path(behaviour.yaml),
  fields: { ...fields },
});
/** An empty `to` removes the entry, an empty `when` its condition, an empty `sets` its changes of memory. */
export const changeNext = (behaviour: Behaviour, entry: number, fields: Partial<Behaviour["next"][number]>): Edit => ({
  ...addNext(behaviour, {}),
  key: String(entry),
  fields,
});
