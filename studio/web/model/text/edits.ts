import { references, referencesInto, referencesTo, type Reference } from "../structure/references";
import {
  type Agent,
  type Behaviour,
  type Buffer,
  type Channel,
  type Structure,
  type Subsystem,
  type SubsystemKind,
} from "../structure/structure";
import { nextToRemove } from "./next_edits";
import { apply, scalarText, type TextEdit, type YamlPath, type YamlText } from "./yaml_text";

/**
 * Changes of a specification. Each function takes the structure of a text and returns
 * the text after the change. New names are in renames.ts.
 */

const done = (structure: Structure, edits: readonly TextEdit[]) => apply(structure.yaml.text, edits);

/** `name`, with a number if it is taken. */
export function freeName(name: string, taken: readonly string[]): string {
  if (!taken.includes(name)) return name;
  for (let number = 2; ; number += 1) if (!taken.includes(`${name}_${number}`)) return `${name}_${number}`;
}

export const isName = (name: string) => /^[A-Za-z](?:_?[A-Za-z0-9])*$/.test(name) && name.length <= 64;

// ------------------------------------------------------------------------------------------------ add

export function addAgent(structure: Structure, name: string): string {
  const body = { control: { rate: "10 Hz", behaviours: { run: "{}" } } };
  return done(structure, structure.yaml.insert(["agents"], name, body));
}

export function addSubsystem(structure: Structure, agent: Agent, kind: SubsystemKind, name: string): string {
  const body = { rate: "50 Hz", behaviours: { run: "{}" } };
  const at = kind === "control" ? agent.body : [...agent.body, `${kind}s`];
  return done(structure, structure.yaml.insert(at, kind === "control" ? "control" : name, body));
}

export function addBehaviour(structure: Structure, subsystem: Subsystem, name: string): string {
  return done(structure, structure.yaml.insert([...subsystem.yaml, "behaviours"], name, "{}"));
}

const bufferKey = { input: "inputs", output: "outputs", real: "real" } as const;

export function addBuffer(
  structure: Structure,
  subsystem: Subsystem,
  direction: Buffer["direction"],
  name: string,
  type: string,
): string {
  return done(structure, structure.yaml.insert([...subsystem.yaml, bufferKey[direction]], name, scalarText(type)));
}

export interface ChannelModes {
  send: Channel["send"];
  receive: Channel["receive"];
  timeout: string;
}

/** The short form, if it can express the channel. */
function channelText(from: string, to: string, modes: ChannelModes): string {
  const fields = [
    ...(modes.send === "blocking" ? ["send: blocking"] : []),
    ...(modes.receive === "blocking" ? ["receive: blocking"] : []),
    ...(modes.timeout ? [`timeout: ${scalarText(modes.timeout)}`] : []),
  ];
  if (fields.length === 0) return `${from} -> ${to}`;
  return `{ ${[`from: ${scalarText(from)}`, `to: ${scalarText(to)}`, ...fields].join(", ")} }`;
}

export function addChannel(structure: Structure, from: string, to: string, modes: ChannelModes): string {
  return done(structure, structure.yaml.append(["channels"], channelText(from, to, modes)));
}

// ------------------------------------------------------------------------------------------------ change

/** Sets a field such as `rate` or `terminal`; an empty text removes it. */
export function setField(structure: Structure, at: YamlPath, key: string, text: string): string {
  return done(structure, structure.yaml.set(at, key, text));
}

export function setType(structure: Structure, buffer: Buffer, type: string): string {
  return done(structure, structure.yaml.set(buffer.yaml.slice(0, -1), buffer.name, type));
}

export function setChannel(structure: Structure, channel: Channel, change: Partial<ChannelModes>): string {
  const { yaml } = structure;
  const at = ["channels", channel.index];
  if (!yaml.map(at)) return done(structure, yaml.replace(at, channelText(channel.from, channel.to, { ...channel, ...change })));
  const [key, value] = Object.entries(change)[0]!;
  return done(structure, yaml.set(at, key, value === "non_blocking" ? "" : value));
}

/** Gives a channel a communication model of `models:`; empty: one of the built-in ones. */
export function setModel(structure: Structure, channel: Channel, model: string): string {
  const { yaml } = structure;
  const at = ["channels", channel.index];
  if (!yaml.map(at)) return model ? done(structure, yaml.replace(at, channelWithModel(channel, model))) : yaml.text;
  // A model says itself how the ends wait.
  const rest = model ? yaml.without(at, ["send", "receive"]) : yaml;
  return apply(rest.text, rest.set(at, "model", model));
}

const channelWithModel = ({ from, to }: Channel, model: string) =>
  `{ ${[`from: ${scalarText(from)}`, `to: ${scalarText(to)}`, `model: ${scalarText(model)}`].join(", ")} }`;

/** The safe command and the limits of a real buffer. */
export function deviceEntries({ yaml }: Structure, subsystem: Subsystem, { direction, name }: Buffer): YamlPath[] {
  if (direction !== "real") return [];
  return ["safe", "limits"].flatMap((part) =>
    yaml
      .keys([...subsystem.yaml, part])
      .filter((key) => key === name || key.startsWith(`${name}.`))
      .map((key) => [...subsystem.yaml, part, key]),
  );
}

// ------------------------------------------------------------------------------------------------ remove

/** The parts of the file that cannot be without the elements that they name. Properties and checks stay, for the user to judge. */
function dependents({ yaml }: Structure, needed: readonly Reference[]): YamlPath[] {
  const paths = [...new Map(needed.map(({ at }) => [JSON.stringify(at), at])).values()];
  const isIn = (...section: string[]) => paths.filter((at) => section.every((key, index) => at[index] === key));
  return [
    ...[isIn("channels"), isIn("drivers"), isIn("simulation", "drivers"), isIn("simulation", "models")].flat(),
    ...processesWithout(yaml, isIn("deploy")),
  ];
}

/** A process without agents goes, and so does a deployment without processes. */
function processesWithout(yaml: YamlText, agents: readonly YamlPath[]): YamlPath[] {
  const all = yaml.keys(["deploy", "processes"]);
  const removed = all.flatMap((name): YamlPath[] => {
    const process = ["deploy", "processes", name];
    const mine = agents.filter((at) => at[2] === name);
    const list = yaml.seq(yaml.map(process) ? [...process, "agents"] : process);
    return mine.length > 0 && mine.length === (list?.items.length ?? 1) ? [process] : mine;
  });
  return all.length > 0 && removed.filter((at) => at.length === 3).length === all.length ? [["deploy"]] : removed;
}

/**
 * Removes several elements, one after the other: the rest of a list decides how the next one is removed.
 */
function removeAll(structure: Structure, paths: readonly YamlPath[], reread: (text: string) => Structure): string {
  const fromBelow = [...paths].sort(
    (a, b) => structure.yaml.line(b) - structure.yaml.line(a) || Number(b.at(-1)) - Number(a.at(-1)),
  );
  return fromBelow.reduce((now, path) => reread(done(now, now.yaml.remove(path))), structure).yaml.text;
}

export function removeAgent(structure: Structure, agent: Agent, reread: (text: string) => Structure): string {
  const needed = references(structure).filter((one) => one.agent === agent.name);
  return removeAll(structure, [agent.yaml, ...dependents(structure, needed)], reread);
}

export function removeSubsystem(structure: Structure, subsystem: Subsystem, reread: (text: string) => Structure): string {
  return removeAll(structure, [subsystem.yaml, ...dependents(structure, referencesTo(structure, subsystem))], reread);
}

export function removeBuffer(
  structure: Structure,
  subsystem: Subsystem,
  buffer: Buffer,
  reread: (text: string) => Structure,
): string {
  const needed = referencesInto(structure, subsystem).filter(
    ({ kind, name }) => kind === buffer.direction && name === buffer.name,
  );
  return removeAll(
    structure,
    [buffer.yaml, ...deviceEntries(structure, subsystem, buffer), ...dependents(structure, needed)],
    reread,
  );
}

/** Also removes the entries of `next` that lead to it. */
export function removeBehaviour(
  structure: Structure,
  subsystem: Subsystem,
  behaviour: Behaviour,
  reread: (text: string) => Structure,
): string {
  const paths: YamlPath[] = [behaviour.yaml];
  if (subsystem.start === behaviour.name) paths.push([...subsystem.yaml, "start"]);
  for (const other of subsystem.behaviours) {
    if (other === behaviour) continue;
    const hits = other.next.flatMap((entry, at) => (entry.to === behaviour.name ? [at] : []));
    paths.push(...nextToRemove(structure, other, hits));
  }
  return removeAll(structure, paths, reread);
}

export function removeChannel(structure: Structure, channel: Channel): string {
  return done(structure, structure.yaml.remove(["channels", channel.index]));
}
