import { isMap, isScalar, visit, type Node } from "yaml";
import type { YamlPath, YamlText } from "../text/yaml_text";
import type { Direction, Structure, Subsystem } from "./structure";

/**
 * The names of agents, subsystems, behaviours and buffers in the parts of a specification that refer to them: channels,
 * drivers, properties, processes, and the simulated world. The place of a path decides what its third word may name, since
 * a behaviour, an input, an output and a real buffer of a subsystem may all have one name.
 */

/** A word of a path: the `control` of `robot[3].control.line`. */
export interface Reference {
  kind: "agent" | "subsystem" | "behaviour" | Direction;
  agent: string;
  /** Empty for an agent. */
  subsystem: string;
  name: string;
  from: number;
  to: number;
  /** The entry of the file that needs the named element. */
  at: YamlPath;
}

type Member = "behaviour" | Direction;

/** `robot[i].control.line`, not within another word. */
const dotted = /(?<![\w./])([A-Za-z_]\w*)(\[[^\]]*\])?((?:\.\w+)*)(?![\w(])/g;
/** An object of the world: `robot[3]`, `arm/hand`. A word behind a number is its unit. */
const object = /(?<![\w./]|\d\s+)([A-Za-z_]\w*)(?:\[[^\]]*\])?(?![\w.([])/g;
/** The same in a target of a driver, where only an index or a part of the object tells it from other names. */
const target = /(?<![\w./])([A-Za-z_]\w*)(?=\[[^\]]*\]|\/)/g;

export function references(structure: Structure): Reference[] {
  const { yaml, agents } = structure;
  const placed = new Set(yaml.keys(["simulation", "models"]).map(instanceName));
  return [
    ...inChannels(yaml),
    ...[["drivers"], ["simulation", "drivers"]].flatMap((at) => inKeys(yaml, at, "real")),
    ...inProperties(yaml).map((one) => ({ ...one, kind: claimed(structure, one) })),
    ...inProcesses(yaml),
    ...inKeys(yaml, ["simulation", "models"], "real"),
    ...inWorld(yaml).filter(({ agent }) => placed.has(agent)),
  ].filter(({ agent }) => agents.some((one) => one.name === agent));
}

/** The words of paths to and through a subsystem: of all agents that use its template. */
export const referencesTo = (structure: Structure, { yaml }: Subsystem): Reference[] =>
  references(structure).filter((one) => subsystemOf(structure, one)?.yaml.join("/") === yaml.join("/"));

/** The words of paths to the behaviours and buffers of a subsystem. Its aliases have the same ones. */
export function referencesInto(structure: Structure, { yaml }: Subsystem): Reference[] {
  const own = structure.yaml.resolved(yaml);
  return references(structure).filter((one) => {
    const subsystem = one.kind === "subsystem" ? undefined : subsystemOf(structure, one);
    return subsystem !== undefined && structure.yaml.resolved(subsystem.yaml) === own;
  });
}

/** A formula names behaviours, and buffers that have no behaviour of their name: `robot.control.line.full`. */
function claimed(structure: Structure, reference: Reference): Reference["kind"] {
  const { kind, name } = reference;
  const subsystem = kind === "behaviour" ? subsystemOf(structure, reference) : undefined;
  if (!subsystem || subsystem.behaviours.some((one) => one.name === name)) return kind;
  return subsystem.buffers.find((one) => one.direction !== "real" && one.name === name)?.direction ?? kind;
}

const subsystemOf = ({ agents }: Structure, { agent, subsystem }: Reference): Subsystem | undefined =>
  agents.find(({ name }) => name === agent)?.subsystems.find(({ name }) => name === subsystem);

/** The places besides its key at which the simulated world names a placed model: the objects that are not of the world file. */
export const placedReferences = ({ yaml }: Structure, name: string): Reference[] =>
  inWorld(yaml).filter(({ agent }) => agent === instanceName(name));

/** `robot[*]` stands for instances of the name `robot`. */
export const instanceName = (key: string) => key.split("[")[0]!.trim();

function inChannels(yaml: YamlText): Reference[] {
  return (yaml.seq(["channels"])?.items ?? []).flatMap((_, index) => {
    const at = ["channels", index];
    if (!yaml.map(at)) return pathsIn(yaml, yaml.node(at), at, "behaviour");
    return [...pathsIn(yaml, yaml.node([...at, "from"]), at, "output"), ...pathsIn(yaml, yaml.node([...at, "to"]), at, "input")];
  });
}

const inKeys = (yaml: YamlText, map: YamlPath, member: Member): Reference[] =>
  (yaml.map(map)?.items ?? []).flatMap(({ key }) =>
    isScalar(key) ? pathsIn(yaml, key as Node, [...map, String(key.value)], member) : [],
  );

function inProperties(yaml: YamlText): Reference[] {
  return (yaml.seq(["properties"])?.items ?? []).flatMap((_, index) => {
    const at = ["properties", index];
    const kinds = yaml.keys(at).filter((key) => key !== "name");
    return kinds.flatMap((key) => scalarsOf(yaml.node([...at, key])).flatMap((one) => pathsIn(yaml, one, at, "behaviour")));
  });
}

/** A process is an agent, a list of agents, or a map with them. */
function inProcesses(yaml: YamlText): Reference[] {
  return yaml.keys(["deploy", "processes"]).flatMap((name) => {
    const process = ["deploy", "processes", name];
    const at = yaml.map(process) ? [...process, "agents"] : process;
    const list = yaml.seq(at);
    if (!list) return pathsIn(yaml, yaml.node(at), process, "real");
    return list.items.flatMap((item, index) => pathsIn(yaml, item, [...at, index], "real"));
  });
}

/** Objects of the world in checks, measures, and targets of drivers. */
function inWorld(yaml: YamlText): Reference[] {
  const within = (at: YamlPath, pattern: RegExp, without: readonly string[] = []) =>
    (isMap(yaml.node(at)) ? yaml.keys(at) : [])
      .filter((key) => !without.includes(key))
      .flatMap((key) => scalarsOf(yaml.node([...at, key])).flatMap((one) => objectsIn(yaml, one, at, pattern)));
  const checks = yaml.seq(["simulation", "checks"])?.items ?? [];
  return [
    ...checks.flatMap((_, index) => within(["simulation", "checks", index], object, ["name", "within"])),
    ...within(["simulation", "measures"], object),
    ...yaml.keys(["simulation", "drivers"]).flatMap((name) => {
      const at = ["simulation", "drivers", name];
      // The options of a class and the controls of an operator are no objects of the world.
      return ["cpp", "panel"].some((key) => yaml.pair([...at, key])) ? [] : within(at, target);
    }),
  ];
}

function scalarsOf(node: Node | undefined): Node[] {
  const found: Node[] = [];
  if (node) visit(node, { Scalar: (key, scalar) => void (key === "key" || found.push(scalar)) });
  return found;
}

const sourceOf = (yaml: YamlText, node: Node) => yaml.text.slice(node.range![0], node.range![1]);

function objectsIn(yaml: YamlText, node: Node, at: YamlPath, pattern: RegExp): Reference[] {
  if (!node.range) return [];
  return [...sourceOf(yaml, node).matchAll(pattern)].map(({ 1: name, index }) => {
    const from = node.range![0] + index;
    return { kind: "agent", agent: name!, subsystem: "", name: name!, from, to: from + name!.length, at };
  });
}

/** The words of all paths in a scalar. Beside an arrow, the third word is an end of a channel. */
function pathsIn(yaml: YamlText, node: Node | undefined, at: YamlPath, member: Member): Reference[] {
  if (!isScalar(node) || !node.range) return [];
  const source = sourceOf(yaml, node as Node);
  return [...source.matchAll(dotted)].flatMap((found) => {
    const { 0: whole, index } = found;
    const isFrom = /^\s*->/.test(source.slice(index + whole.length));
    const isTo = /->\s*$/.test(source.slice(0, index));
    return wordsOf(found, node.range![0], at, isFrom ? "output" : isTo ? "input" : member);
  });
}

function wordsOf(found: RegExpExecArray, offset: number, at: YamlPath, member: Member): Reference[] {
  const [, agent = "", selector = "", rest = ""] = found;
  const [, subsystem = "", name = ""] = rest.split(".");
  // The places of the system itself: they belong to no agent.
  if (!selector && !rest && (agent === "in" || agent === "out")) return [];
  const begin = offset + found.index;
  const second = begin + agent.length + selector.length + 1;
  const third = second + subsystem.length + 1;
  const word = (kind: Reference["kind"], of: string, from: number): Reference[] =>
    of ? [{ kind, agent, subsystem: kind === "agent" ? "" : subsystem, name: of, from, to: from + of.length, at }] : [];
  return [...word("agent", agent, begin), ...word("subsystem", subsystem, second), ...word(member, name, third)];
}
