import { visit, type Node } from "yaml";
import {
  instanceName,
  placedReferences,
  references,
  referencesInto,
  referencesTo,
  type Reference,
} from "../structure/references";
import { readStructure, type Agent, type Behaviour, type Buffer, type Structure, type Subsystem } from "../structure/structure";
import { deviceEntries } from "./edits";
import { nextTargets } from "./next_edits";
import { apply, scalarText, type TextEdit, type YamlPath, type YamlText } from "./yaml_text";

/** New names. Each function returns the text with the new name wherever the specification uses it. C++ is not changed. */

const escaped = (name: string) => name.replace(/[.*+?^${}()|[\]\\]/g, "\\$&");
/** A scalar that is the name and nothing else. */
const whole = (name: string) => new RegExp(`^(["']?)${escaped(name)}\\1$`);

const done = ({ yaml }: Structure, edits: readonly TextEdit[]) => apply(yaml.text, distinct(edits));

/** Parts of templates are found once for each agent that uses them. */
const distinct = (edits: readonly TextEdit[]) =>
  edits.filter(({ from }, at) => edits.findIndex((one) => one.from === from) === at);

const renamed = (found: readonly Reference[], name: string): TextEdit[] =>
  found.map(({ from, to }) => ({ from, to, insert: name }));

// ------------------------------------------------------------------------------------------------ elements

export function renameAgent(structure: Structure, agent: Agent, name: string): string {
  const used = references(structure).filter((one) => one.kind === "agent" && one.agent === agent.name);
  return done(structure, [...structure.yaml.renameKey(agent.yaml, name), ...renamed(used, name)]);
}

export function renameSubsystem(structure: Structure, subsystem: Subsystem, name: string): string {
  const used = referencesTo(structure, subsystem).filter(({ kind }) => kind === "subsystem");
  return done(structure, [...structure.yaml.renameKey(subsystem.yaml, name), ...renamed(used, name)]);
}

const membersNamed = (structure: Structure, subsystem: Subsystem, kind: Reference["kind"], name: string) =>
  referencesInto(structure, subsystem).filter((one) => one.kind === kind && one.name === name);

export function renameBehaviour(structure: Structure, subsystem: Subsystem, behaviour: Behaviour, name: string): string {
  const { yaml } = structure;
  const used = [
    yaml.node([...subsystem.yaml, "start"]),
    ...subsystem.behaviours.flatMap((other) => nextTargets(structure, other)),
  ];
  return done(structure, [
    ...yaml.renameKey(behaviour.yaml, name),
    ...used.flatMap((node) => yaml.replaceWithin(node, whole(behaviour.name), `$1${name}$1`)),
    ...renamed(membersNamed(structure, subsystem, "behaviour", behaviour.name), name),
  ]);
}

export function renameBuffer(structure: Structure, subsystem: Subsystem, buffer: Buffer, name: string): string {
  const { yaml } = structure;
  return done(structure, [
    ...yaml.renameKey(buffer.yaml, name),
    ...renamed(membersNamed(structure, subsystem, buffer.direction, buffer.name), name),
    ...deviceEntries(structure, subsystem, buffer).flatMap((at) =>
      yaml.renameKey(at, name + String(at.at(-1)).slice(buffer.name.length)),
    ),
    ...inConditions(structure, subsystem, sideOf(subsystem, buffer), buffer.name, name),
    ...inLists(structure, subsystem, buffer, name),
  ]);
}

/** The object that holds a buffer in conditions: a receptor reads its real buffers, an effector writes them. */
const sideOf = ({ kind }: Subsystem, { direction }: Buffer): "in" | "out" =>
  direction === "input" || (direction === "real" && kind === "receptor") ? "in" : "out";

const listOf = { input: "receive", output: "send", real: undefined } as const;

/** The lists of behaviours that name a buffer. */
function inLists({ yaml }: Structure, subsystem: Subsystem, buffer: Buffer, name: string): TextEdit[] {
  const key = listOf[buffer.direction];
  if (!key) return [];
  return subsystem.behaviours.flatMap((behaviour) =>
    scalarsIn(yaml, [...behaviour.yaml, key]).flatMap((one) => yaml.replaceWithin(one, whole(buffer.name), `$1${name}$1`)),
  );
}

/** `in.line`, `memory.count`: a name behind its base, in the conditions of a subsystem. */
function inConditions({ yaml }: Structure, subsystem: Subsystem, base: string, from: string, to: string): TextEdit[] {
  const used = new RegExp(`(?<![\\w.])(${base}\\s*\\.\\s*)${escaped(from)}\\b`, "g");
  const parts = subsystem.behaviours.flatMap((one) => ["terminal", "error", "next"].map((key) => [...one.yaml, key]));
  return parts.flatMap((at) => scalarsIn(yaml, at).flatMap((one) => yaml.replaceWithin(one, used, `$1${to}`)));
}

function scalarsIn(yaml: YamlText, at: YamlPath): Node[] {
  const found: Node[] = [];
  visit(yaml.node(at) ?? null, { Scalar: (key, scalar) => void (key === "key" || found.push(scalar)) });
  return found;
}

// ------------------------------------------------------------------------------------------------ names of maps

/** Renames a cell of the memory, or a parameter, of a subsystem. */
export function renameCell(
  structure: Structure,
  subsystem: Subsystem,
  part: "memory" | "parameters",
  from: string,
  to: string,
): string {
  return done(structure, [
    ...structure.yaml.renameKey([...subsystem.yaml, part, from], to),
    ...inConditions(structure, subsystem, part, from, to),
  ]);
}

/** Everything below `agents`, `templates` and `types` that may name a type: a whole word of a scalar. */
export function renameType(text: string, from: string, to: string): string {
  const structure = readStructure(text);
  const { yaml } = structure;
  const word = new RegExp(`(?<![\\w.])${escaped(from)}(?![\\w])`, "g");
  const bodies = [...structure.agents.map(({ body }) => body), ...yaml.keys(["templates"]).map((name) => ["templates", name])];
  const places = bodies
    .flatMap((body) => subsystemPaths(yaml, body))
    .flatMap((at) => ["inputs", "outputs", "real", "memory"].map((key) => [...at, key]));
  return done(structure, [
    ...yaml.renameKey(["types", from], to),
    ...[["types"], ...places].flatMap((at) => scalarsIn(yaml, at).flatMap((one) => yaml.replaceWithin(one, word, to))),
  ]);
}

const subsystemPaths = (yaml: YamlText, agent: YamlPath): YamlPath[] => [
  [...agent, "control"],
  ...["receptors", "effectors"].flatMap((kind) => yaml.keys([...agent, kind]).map((name) => [...agent, kind, name])),
];

/** Renames a parameter of the system, also in conditions. */
export function renameParameter(text: string, from: string, to: string): string {
  const structure = readStructure(text);
  const { yaml } = structure;
  const word = new RegExp(`\\bparameters\\.${escaped(from)}\\b`, "g");
  const used = ["agents", "templates"].flatMap((part) => scalarsIn(yaml, [part]));
  return done(structure, [
    ...yaml.renameKey(["parameters", from], to),
    ...used.flatMap((one) => yaml.replaceWithin(one, word, `parameters.${to}`)),
  ]);
}

/** Renames a template or a communication model, and the name where it is used. */
export function renameUsed(text: string, part: "templates" | "models", from: string, to: string): string {
  const structure = readStructure(text);
  const { yaml } = structure;
  const used =
    part === "models"
      ? structure.channels.map(({ index }) => ["channels", index, "model"])
      : ["agents", "templates"].flatMap((at) => yaml.keys([at]).map((name) => [at, name, "use"]));
  return done(structure, [
    ...yaml.renameKey([part, from], to),
    ...used.flatMap((at) => yaml.replaceWithin(yaml.node(at), whole(from), `$1${to}$1`)),
  ]);
}

/** Renames a model that is placed in the world, also in checks and measures. `from` and `to` may have an index. */
export function renamePlaced(text: string, from: string, to: string): string {
  const structure = readStructure(text);
  const at = ["simulation", "models"];
  const key = structure.yaml.map(at)?.flow ? scalarText(to) : to;
  const others = structure.yaml.keys(at).some((one) => one !== from && instanceName(one) === instanceName(from));
  return done(structure, [
    ...structure.yaml.renameKey([...at, from], key),
    // `robot[0]` and `robot[1]` may be placed one by one: the checks go on to name those that stay.
    ...(others ? [] : renamed(placedReferences(structure, from), instanceName(to))),
  ]);
}
