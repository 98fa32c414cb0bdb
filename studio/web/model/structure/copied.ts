import { elementText } from "../text/element_text";
import { YamlText, type YamlPath } from "../text/yaml_text";
import { findThing, withoutIndex, type Agent, type Structure, type Subsystem, type Thing } from "./structure";

/**
 * Elements in the clipboard: YAML text with a first line that says what it is, so that it can be pasted in another
 * project, and read in any editor.
 */

const words = {
  agent: "agent",
  control: "control subsystem",
  receptor: "virtual receptor",
  effector: "virtual effector",
  behaviour: "behaviour",
  input: "input buffer",
  output: "output buffer",
  real: "real buffer",
} as const;
export type CopiedKind = keyof typeof words;

export interface Copied {
  kind: CopiedKind;
  name: string;
  /** Without the line that says what it is. */
  text: string;
}

const mark = "# Tessera: ";

export function kindOf(thing: Thing): CopiedKind | undefined {
  switch (thing.kind) {
    case "agent":
      return "agent";
    case "subsystem":
      return thing.of.kind;
    case "behaviour":
      return "behaviour";
    case "buffer":
      return thing.of.direction;
    default:
      return undefined;
  }
}

/** The name of an element's kind: "virtual receptor", "group of behaviours". */
export function kindName(thing: Thing): string {
  if (thing.kind === "behaviour" && thing.of.isGroup) return "group of behaviours";
  const kind = kindOf(thing);
  return kind ? words[kind] : thing.kind;
}

/** The text of an element for the clipboard; undefined: it cannot be copied. */
export function copiedText(structure: Structure, thing: Thing): string | undefined {
  const kind = kindOf(thing);
  if (!kind || thing.kind === "channel") return undefined;
  return `${mark}${words[kind]}\n${elementText(structure.yaml, thing.of.yaml)}`;
}

/** The kind of an element by its keys, if no line says it. */
function guessed(yaml: YamlText, name: string): CopiedKind | undefined {
  const keys = yaml.keys([name]);
  const has = (...some: string[]) => some.some((key) => keys.includes(key));
  if (has("control", "receptors", "effectors", "count")) return "agent";
  if (has("terminal", "next", "error", "until", "takes", "transfer")) return "behaviour";
  if (has("real", "rate", "inputs", "outputs"))
    return name === "control" ? "control" : has("inputs") && has("real") ? "effector" : has("real") ? "receptor" : undefined;
  return keys.length === 0 && yaml.map([name]) ? "behaviour" : undefined;
}

/** An element in a text of the clipboard; undefined: there is none. */
export function readCopied(clipboard: string): Copied | undefined {
  const all = clipboard.replace(/\r\n?/g, "\n");
  const [first = "", ...rest] = all.split("\n");
  const marked = first.startsWith(mark);
  const text = marked ? rest.join("\n") : all;
  if (text.length > 1_000_000) return undefined;
  const yaml = new YamlText(text);
  const [name, ...others] = yaml.keys([]);
  if (name === undefined || others.length > 0) return undefined;
  const said = first.slice(mark.length).trim();
  const kind = marked ? (Object.keys(words) as CopiedKind[]).find((one) => words[one] === said) : guessed(yaml, name);
  return kind && { kind, name, text: text.endsWith("\n") ? text : `${text}\n` };
}

/** The place for a pasted element. */
export interface Place {
  map: YamlPath;
  /** The maps in which its name must be free. */
  taken: YamlPath[];
  select: (name: string) => string;
  /** The name that it must have; undefined: any free one. */
  name?: string;
}

const agentAt = (structure: Structure, selected: string | null): Agent | undefined => {
  const thing = selected === null ? undefined : findThing(structure, withoutIndex(selected));
  if (!thing || thing.kind === "channel") return structure.agents.length === 1 ? structure.agents[0] : undefined;
  if (thing.kind === "agent" || thing.kind === "template") return thing.of;
  if (thing.kind === "subsystem") return thing.agent;
  const owner = findThing(structure, thing.subsystem.path);
  return owner?.kind === "subsystem" ? owner.agent : undefined;
};

const subsystemAt = (structure: Structure, selected: string | null): Subsystem | undefined => {
  const thing = selected === null ? undefined : findThing(structure, withoutIndex(selected));
  if (thing?.kind === "subsystem") return thing.of;
  return thing?.kind === "behaviour" || thing?.kind === "buffer" ? thing.subsystem : undefined;
};

/** The maps that hold the names of a subsystem. */
const namesOf = ({ yaml }: Subsystem): YamlPath[] => ["behaviours", "inputs", "outputs", "real"].map((key) => [...yaml, key]);

/** The place where an element is pasted while another one is selected; a text: why it cannot be. */
export function placeFor(structure: Structure, selected: string | null, { kind }: Copied): Place | string {
  if (kind === "agent") return { map: ["agents"], taken: [["agents"]], select: (name) => name };
  if (kind === "control" || kind === "receptor" || kind === "effector") {
    const agent = agentAt(structure, selected);
    if (!agent) return "Select the agent to paste it into";
    const select = (name: string) => `${agent.name}.${name}`;
    if (kind !== "control") {
      const maps = [...(["receptors", "effectors"] as const).map((key) => [...agent.body, key])];
      return { map: [...agent.body, `${kind}s`], taken: maps, select };
    }
    if (agent.subsystems.some((one) => one.kind === "control")) return `${agent.name} has its control subsystem already`;
    return { map: agent.body, taken: [], select, name: "control" };
  }
  const subsystem = subsystemAt(structure, selected);
  if (!subsystem) return "Select the subsystem to paste it into";
  if (kind !== "behaviour") {
    if (kind === "real" && subsystem.kind === "control") return "A control subsystem has no real buffers";
    const key = kind === "real" ? "real" : `${kind}s`;
    const select = (name: string) => `${kind}:${subsystem.path}.${name}`;
    return { map: [...subsystem.yaml, key], taken: namesOf(subsystem), select };
  }
  const thing = selected === null ? undefined : findThing(structure, withoutIndex(selected));
  const around = thing?.kind === "behaviour" ? (thing.of.isGroup ? thing.of.path : thing.of.group) : "";
  const group = subsystem.behaviours.find(({ path, template }) => path === around && !template);
  const map = [...(group ? group.yaml : subsystem.yaml), "behaviours"];
  const select = (name: string) => `${group ? group.path : subsystem.path}.${name}`;
  return { map, taken: group ? [map] : namesOf(subsystem), select };
}

/** The maps in which the name of a copy beside an element must be free. */
export function namesAround(thing: Thing): YamlPath[] {
  switch (thing.kind) {
    case "agent":
      return [["agents"]];
    case "subsystem":
      return ["receptors", "effectors"].map((key) => [...thing.agent.body, key]);
    case "behaviour":
      return thing.of.group ? [thing.of.yaml.slice(0, -1)] : namesOf(thing.subsystem);
    case "buffer":
      return namesOf(thing.subsystem);
    default:
      return [];
  }
}

/** `look_2` is a copy of `look`. */
export const baseName = (name: string) => name.replace(/_[0-9]+$/, "");

/** Counts what a copy of an agent has not: the channels to other agents, and the drivers of its buffers. */
export function notCopied({ channels, yaml }: Structure, agent: Agent): { channels: number; drivers: number } {
  const isOwn = (path: string) => withoutIndex(path).split(".")[0] === agent.name;
  const crossing = channels.filter(({ from, to }) => isOwn(from) !== isOwn(to));
  const drivers = [...yaml.keys(["drivers"]), ...yaml.keys(["simulation", "drivers"])].filter(isOwn);
  return { channels: crossing.length, drivers: drivers.length };
}
