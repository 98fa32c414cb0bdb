import type { Node } from "yaml";
import { isMap, isPair, isScalar, visit } from "yaml";
import {
  readStructure,
  withoutIndex,
  type Agent,
  type Behaviour,
  type Buffer,
  type Channel,
  type Structure,
  type Subsystem,
  type SubsystemKind,
} from "../structure/structure";
import { apply, scalarText, type TextEdit, type YamlPath } from "./yaml_text";

/**
 * Changes of a specification. Each function takes the structure of a text and returns
 * the text after the change.
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
  if (!model) return done(structure, yaml.remove([...at, "model"]));
  if (channel.model) return done(structure, yaml.set(at, "model", model));
  const { from, to, timeout } = channel;
  const kept = yaml.keys(at).filter((key) => !["from", "to", "send", "receive", "timeout"].includes(key));
  const parts = [
    ["from", from],
    ["to", to],
    ["model", model],
    ...(timeout ? [["timeout", timeout]] : []),
    ...kept.map((key) => [key, yaml.valueText([...at, key]) ?? ""]),
  ].map(([key, value]) => `${key}: ${scalarText(value!)}`);
  return done(structure, yaml.replace(at, `{ ${parts.join(", ")} }`));
}

/** Sets the entries of `next` in order. A single unconditional entry is written in short form. */
export function setNext(structure: Structure, behaviour: Behaviour, next: readonly { to: string; when: string }[]): string {
  const one = (entry: { to: string; when: string }) =>
    entry.when ? `{ to: ${entry.to}, when: ${scalarText(entry.when)} }` : entry.to;
  const [first] = next;
  const text = next.length === 0 ? "" : next.length === 1 && first && !first.when ? first.to : `[${next.map(one).join(", ")}]`;
  return setField(structure, behaviour.yaml, "next", text);
}

// ------------------------------------------------------------------------------------------------ rename

const escaped = (name: string) => name.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
const index = String.raw`(?:\[[^\]]*\])?`;

/** Scalars that name things by path: ends of channels, drivers, properties. */
function pathScalars(structure: Structure): Node[] {
  const found: Node[] = [];
  const { yaml } = structure;
  for (const at of [["channels"], ["drivers"], ["simulation", "drivers"], ["properties"]]) {
    const node = yaml.node(at);
    if (node) visit(node, { Scalar: (_, scalar) => void found.push(scalar) });
  }
  return found;
}

function renamePaths(structure: Structure, pattern: RegExp, by: string): TextEdit[] {
  return pathScalars(structure).flatMap((scalar) => structure.yaml.replaceWithin(scalar, pattern, by));
}

export function renameAgent(structure: Structure, agent: Agent, name: string): string {
  const pattern = new RegExp(`(?<![\\w.])${escaped(agent.name)}(?=${index}\\.)`, "g");
  return done(structure, [...structure.yaml.renameKey(agent.yaml, name), ...renamePaths(structure, pattern, name)]);
}

/** The text of all agents that share that part of the file. */
function sharing(structure: Structure, body: YamlPath): string {
  const names = structure.agents.filter((agent) => agent.body.join("/") === body.join("/")).map((agent) => escaped(agent.name));
  return names.length > 0 ? `(?:${names.join("|")})` : "(?!)";
}

const bodyOf = (subsystem: Subsystem): YamlPath => subsystem.yaml.slice(0, 2);

export function renameSubsystem(structure: Structure, subsystem: Subsystem, name: string): string {
  const pattern = new RegExp(
    `(?<![\\w.])(${sharing(structure, bodyOf(subsystem))}${index})\\.${escaped(subsystem.name)}(?![\\w])`,
    "g",
  );
  return done(structure, [...structure.yaml.renameKey(subsystem.yaml, name), ...renamePaths(structure, pattern, `$1.${name}`)]);
}

/** Paths that continue after the subsystem: its behaviours and buffers. */
const memberPattern = (structure: Structure, subsystem: Subsystem, member: string) =>
  new RegExp(
    `(?<![\\w.])(${sharing(structure, bodyOf(subsystem))}${index}\\.${escaped(subsystem.name)})\\.${escaped(member)}(?![\\w])`,
    "g",
  );

export function renameBehaviour(structure: Structure, subsystem: Subsystem, behaviour: Behaviour, name: string): string {
  const { yaml } = structure;
  const whole = new RegExp(`^(["']?)${escaped(behaviour.name)}\\1$`);
  const references = [
    yaml.node([...subsystem.yaml, "start"]),
    ...subsystem.behaviours.flatMap((other) => nextTargets(structure, other)),
  ];
  return done(structure, [
    ...yaml.renameKey(behaviour.yaml, name),
    ...references.flatMap((node) => yaml.replaceWithin(node, whole, `$1${name}$1`)),
    ...renamePaths(structure, memberPattern(structure, subsystem, behaviour.name), `$1.${name}`),
  ]);
}

function nextTargets(structure: Structure, behaviour: Behaviour): (Node | undefined)[] {
  const { yaml } = structure;
  const at = [...behaviour.yaml, "next"];
  const node = yaml.node(at);
  if (isScalar(node)) return [node];
  return (yaml.seq(at)?.items ?? []).map((item, number) => (isMap(item) ? yaml.node([...at, number, "to"]) : item));
}

/** Everything below `agents`, `templates` and `types` that may name a type: a whole word of a scalar. */
export function renameType(text: string, from: string, to: string): string {
  const structure = readStructure(text);
  const { yaml } = structure;
  const word = new RegExp(`(?<![\\w.])${escaped(from)}(?![\\w])`, "g");
  const edits = yaml.renameKey(["types", from], to);
  const inside = (at: YamlPath) => {
    const node = yaml.node(at);
    if (node)
      visit(node, { Scalar: (key, scalar) => void (key === "key" || edits.push(...yaml.replaceWithin(scalar, word, to))) });
  };
  inside(["types"]);
  for (const agent of [
    ...structure.agents.map(({ body }) => body),
    ...yaml.keys(["templates"]).map((name) => ["templates", name]),
  ])
    for (const at of subsystemPaths(yaml, agent)) for (const key of ["inputs", "outputs", "real", "memory"]) inside([...at, key]);
  return apply(text, distinct(edits));
}

/** Renames a parameter of the system, also in conditions. C++ that uses it is not changed. */
export function renameParameter(text: string, from: string, to: string): string {
  const { yaml } = readStructure(text);
  const word = new RegExp(`\\bparameters\\.${escaped(from)}\\b`, "g");
  const edits = yaml.renameKey(["parameters", from], to);
  for (const part of ["agents", "templates"]) {
    const node = yaml.node([part]);
    if (node) visit(node, { Scalar: (_, scalar) => void edits.push(...yaml.replaceWithin(scalar, word, `parameters.${to}`)) });
  }
  return apply(text, distinct(edits));
}

const subsystemPaths = (yaml: Structure["yaml"], agent: YamlPath): YamlPath[] => [
  [...agent, "control"],
  ...["receptors", "effectors"].flatMap((kind) => yaml.keys([...agent, kind]).map((name) => [...agent, kind, name])),
];

/** Parts of templates are found once for each agent that uses them. */
const distinct = (edits: readonly TextEdit[]) =>
  edits.filter(({ from }, at) => edits.findIndex((one) => one.from === from) === at);

/** The safe command and the limits of a real buffer. */
function deviceEntries({ yaml }: Structure, subsystem: Subsystem, { direction, name }: Buffer): YamlPath[] {
  if (direction !== "real") return [];
  return ["safe", "limits"].flatMap((part) =>
    yaml
      .keys([...subsystem.yaml, part])
      .filter((key) => key === name || key.startsWith(`${name}.`))
      .map((key) => [...subsystem.yaml, part, key]),
  );
}

/** Renames a template or a communication model, and the name where it is used. */
export function renameUsed(text: string, part: "templates" | "models", from: string, to: string): string {
  const structure = readStructure(text);
  const { yaml } = structure;
  const used =
    part === "models"
      ? structure.channels.map(({ index }) => ["channels", index, "model"])
      : ["agents", "templates"].flatMap((at) => yaml.keys([at]).map((name) => [at, name, "use"]));
  const whole = new RegExp(`^(["']?)${escaped(from)}\\1$`);
  return apply(text, [
    ...yaml.renameKey([part, from], to),
    ...used.flatMap((at) => yaml.replaceWithin(yaml.node(at), whole, `$1${to}$1`)),
  ]);
}

export function renameBuffer(structure: Structure, subsystem: Subsystem, buffer: Buffer, name: string): string {
  const { yaml } = structure;
  const side = buffer.direction === "input" ? "in" : "out";
  const listed = buffer.direction === "input" ? "receive" : "send";
  const used = new RegExp(`\\b${side}\\.${escaped(buffer.name)}\\b`, "g");
  const whole = new RegExp(`^(["']?)${escaped(buffer.name)}\\1$`);
  const edits = [
    ...yaml.renameKey(buffer.yaml, name),
    ...renamePaths(structure, memberPattern(structure, subsystem, buffer.name), `$1.${name}`),
  ];
  for (const at of deviceEntries(structure, subsystem, buffer))
    edits.push(...yaml.renameKey(at, name + String(at.at(-1)).slice(buffer.name.length)));
  for (const behaviour of subsystem.behaviours)
    visit(yaml.node(behaviour.yaml) ?? null, {
      Scalar: (key, scalar, ancestors) => {
        if (key === "key") return;
        const list = ancestors.some((one) => isPair(one) && isScalar(one.key) && one.key.value === listed);
        edits.push(...yaml.replaceWithin(scalar, list ? whole : used, list ? `$1${name}$1` : `${side}.${name}`));
      },
    });
  return done(structure, edits);
}

// ------------------------------------------------------------------------------------------------ remove

const touches = (end: string, path: string) => withoutIndex(end) === path || withoutIndex(end).startsWith(`${path}.`);

/** Channels, drivers and properties that need the elements at the paths. */
function dependents(structure: Structure, paths: readonly string[]): YamlPath[] {
  const hit = (end: string) => paths.some((path) => touches(end, path));
  const { yaml } = structure;
  const channels = structure.channels
    .filter((one) => hit(one.from) || hit(one.to))
    .map((one): YamlPath => ["channels", one.index]);
  const drivers = [["drivers"], ["simulation", "drivers"]].flatMap((at) =>
    yaml
      .keys(at)
      .filter(hit)
      .map((key): YamlPath => [...at, key]),
  );
  return [...channels, ...drivers];
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
  return removeAll(structure, [agent.yaml, ...dependents(structure, [agent.name])], reread);
}

const everywhere = (structure: Structure, subsystem: Subsystem, rest: string) =>
  structure.agents
    .filter((agent) => agent.body.join("/") === bodyOf(subsystem).join("/"))
    .map((agent) => `${agent.name}.${subsystem.name}${rest}`);

export function removeSubsystem(structure: Structure, subsystem: Subsystem, reread: (text: string) => Structure): string {
  return removeAll(structure, [subsystem.yaml, ...dependents(structure, everywhere(structure, subsystem, ""))], reread);
}

export function removeBuffer(
  structure: Structure,
  subsystem: Subsystem,
  buffer: Buffer,
  reread: (text: string) => Structure,
): string {
  return removeAll(
    structure,
    [
      buffer.yaml,
      ...deviceEntries(structure, subsystem, buffer),
      ...dependents(structure, everywhere(structure, subsystem, `.${buffer.name}`)),
    ],
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
    const list = structure.yaml.seq([...other.yaml, "next"]) !== undefined;
    const hits = other.next.flatMap((entry, at) => (entry.to === behaviour.name ? [at] : []));
    if (hits.length === other.next.length && hits.length > 0) paths.push([...other.yaml, "next"]);
    else if (list) paths.push(...hits.map((at): YamlPath => [...other.yaml, "next", at]));
  }
  return removeAll(structure, paths, reread);
}

export function removeChannel(structure: Structure, channel: Channel): string {
  return done(structure, structure.yaml.remove(["channels", channel.index]));
}
