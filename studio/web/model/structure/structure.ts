import { isScalar } from "yaml";
import { withoutIndex, templatePath, channelPath, bufferSelection, selectedPath } from "./selection";
import { YamlText, type YamlPath } from "../text/yaml_text";

export { withoutIndex, templatePath, channelPath, bufferSelection, nextSelection, nextEntryOf, selectedPath } from "./selection";

/**
 * A specification in the terms of robotics: agents with a control subsystem, virtual receptors and effectors,
 * buffers and channels. It is read from the text as far as possible, so that a file with errors is shown,
 * too. The parser of the server decides on errors.
 */

export type Direction = "input" | "output" | "real";
export interface Buffer {
  name: string;
  path: string;
  /** The path that selects it: a behaviour and other buffers of the subsystem may have its name. */
  selection: string;
  direction: Direction;
  type: string;
  yaml: YamlPath;
  line: number;
}
/** A behaviour, or a group of behaviours, which stands before what is in it. */
export interface Behaviour {
  name: string;
  path: string;
  /** The path of the group that it is in; empty: it is in the subsystem itself. */
  group: string;
  isGroup: boolean;
  /** The template that a group uses; empty: its behaviours are its own. */
  template: string;
  /** The template in which it is written; empty: it is written here. */
  inTemplate: string;
  /** The function in C++: "charge_ask". */
  function: string;
  /** "each robot": there is one for each member of a fleet; empty: it is one. */
  for: string;
  yaml: YamlPath;
  line: number;
  terminal: string;
  error: string;
  /** Changes of memory when it begins: "{ lent_to: a }"; empty: none. */
  sets: string;
  next: { to: string; when: string; sets: string }[];
}
export type SubsystemKind = "control" | "receptor" | "effector";
export interface Subsystem {
  name: string;
  path: string;
  kind: SubsystemKind;
  yaml: YamlPath;
  line: number;
  endLine: number;
  rate: string;
  start: string;
  /** Also those in groups, in the order of the file. */
  behaviours: Behaviour[];
  buffers: Buffer[];
}
export interface Agent {
  name: string;
  yaml: YamlPath;
  /** The part of the file with its subsystems: at the agent or at its template. */
  body: YamlPath;
  template: string;
  /** Whether the template is in an included file: the text does not have its subsystems then. */
  included: boolean;
  count: string;
  line: number;
  subsystems: Subsystem[];
}
export interface Channel {
  index: number;
  /** As written, `robot[i].control.x`. */
  from: string;
  to: string;
  /** A mode of the schema: "blocking". */
  send: string;
  receive: string;
  timeout: string;
  model: string;
  line: number;
}
export interface Structure {
  yaml: YamlText;
  system: string;
  types: string[];
  agents: Agent[];
  channels: Channel[];
}
export type Thing =
  | { kind: "agent"; of: Agent }
  | { kind: "template"; of: Agent }
  | { kind: "subsystem"; of: Subsystem; agent: Agent }
  | { kind: "behaviour"; of: Behaviour; subsystem: Subsystem }
  | { kind: "buffer"; of: Buffer; subsystem: Subsystem }
  | { kind: "channel"; of: Channel };

export function readStructure(text: string): Structure {
  const yaml = new YamlText(text);
  return {
    yaml,
    system: yaml.valueText(["system"]) ?? "",
    types: yaml.keys(["types"]),
    agents: yaml.keys(["agents"]).map((name) => readAgent(yaml, ["agents", name], name)),
    channels: (yaml.seq(["channels"])?.items ?? []).map((_, index) => readChannel(yaml, index)),
  };
}

let last: { text: string; structure: Structure }[] = [];

/** The same, read once for all who ask for one of the last texts. */
export function structureOf(text: string): Structure {
  const known = last.find((one) => one.text === text);
  if (!known) last = [{ text, structure: readStructure(text) }, ...last].slice(0, 4);
  return (known ?? last[0]!).structure;
}

/** The template of a name, with its subsystems; undefined: there is none. */
export function readTemplate({ yaml }: Structure, name: string): Agent | undefined {
  const at = ["templates", name];
  return yaml.pair(at) && readAgent(yaml, at, templatePath(name));
}

/** The agents whose subsystems are at the same part of the file. */
export const sharersOf = (structure: Structure, { body }: Agent) =>
  structure.agents.filter((one) => one.body.join("/") === body.join("/"));

function readAgent(yaml: YamlText, at: YamlPath, name: string): Agent {
  const template = yaml.valueText([...at, "use"]) ?? "";
  const body = bodyOf(yaml, at);
  const subsystems = [
    ...(yaml.pair([...body, "control"]) ? [readSubsystem(yaml, name, "control", [...body, "control"])] : []),
    ...(["receptor", "effector"] as const).flatMap((kind) =>
      yaml.keys([...body, `${kind}s`]).map((own) => readSubsystem(yaml, name, kind, [...body, `${kind}s`, own])),
    ),
  ];
  const included = template !== "" && !yaml.pair(body) && yaml.pair(["include"]) !== undefined;
  const count = yaml.valueText([...at, "count"]) ?? "";
  return { name, yaml: at, body, template, included, count, line: yaml.line(at), subsystems };
}

/** A template may refer to another template. */
function bodyOf(yaml: YamlText, at: YamlPath): YamlPath {
  const seen = new Set<string>();
  let body = at;
  for (let use = yaml.valueText([...body, "use"]); use && !seen.has(use); use = yaml.valueText([...body, "use"])) {
    seen.add(use);
    body = ["templates", use];
  }
  return body;
}

function readSubsystem(yaml: YamlText, agent: string, kind: SubsystemKind, at: YamlPath): Subsystem {
  const name = String(at.at(-1));
  const path = `${agent}.${name}`;
  const buffers = (
    [
      ["inputs", "input"],
      ["outputs", "output"],
      ["real", "real"],
    ] as const
  ).flatMap(([key, direction]) =>
    yaml.keys([...at, key]).map((own): Buffer => {
      const where = [...at, key, own];
      return {
        name: own,
        path: `${path}.${own}`,
        selection: bufferSelection(direction, `${path}.${own}`),
        direction,
        type: yaml.valueText(where) ?? "",
        yaml: where,
        line: yaml.line(where),
      };
    }),
  );
  const behaviours = readBehaviours(yaml, path, [...at, "behaviours"]);
  const field = (key: string) => yaml.valueText([...at, key]) ?? "";
  return {
    name,
    path,
    kind,
    yaml: at,
    line: yaml.line(at),
    endLine: yaml.endLine(at),
    rate: field("rate"),
    start: field("start"),
    behaviours,
    buffers,
  };
}

/** Groups are at most that deep in one another (src/spec/groups/groups.hpp). */
const deepestGroup = 8;

/** open: the templates around, so that those that use each other in a circle end. */
function readBehaviours(
  yaml: YamlText,
  subsystem: string,
  at: YamlPath,
  around = "",
  open: string[] = [],
  depth = 0,
): Behaviour[] {
  return yaml.keys(at).flatMap((own) => {
    const behaviour = readBehaviour(yaml, subsystem, [...at, own], around);
    const { template } = behaviour;
    if (!behaviour.isGroup || depth >= deepestGroup || open.includes(template)) return [behaviour];
    const group = behaviour.path.slice(subsystem.length + 1);
    const body = template ? ["templates", template] : [...at, own];
    const within = template ? [...open, template] : open;
    return [behaviour, ...readBehaviours(yaml, subsystem, [...body, "behaviours"], group, within, depth + 1)];
  });
}

/** The behaviours and groups of a group, by its path; those of the subsystem itself. */
export const behavioursIn = ({ behaviours }: Subsystem, group = "") => behaviours.filter((one) => one.group === group);

/** The names that an entry of `next`, `start` and `on_error` have: with an index of a member, if there is one for each. */
export const targetsIn = (subsystem: Subsystem, group = "", index = "[0]") =>
  behavioursIn(subsystem, group).map((one) => (one.for ? one.name + index : one.name));

function readBehaviour(yaml: YamlText, subsystem: string, at: YamlPath, around: string): Behaviour {
  const name = String(at.at(-1));
  const path = around ? `${subsystem}.${around}.${name}` : `${subsystem}.${name}`;
  return {
    name,
    path,
    group: around && `${subsystem}.${around}`,
    isGroup: yaml.pair([...at, "behaviours"]) !== undefined || yaml.pair([...at, "use"]) !== undefined,
    template: yaml.valueText([...at, "use"]) ?? "",
    inTemplate: at[0] === "templates" && at[2] === "behaviours" ? String(at[1]) : "",
    function: path.slice(subsystem.length + 1).replaceAll(".", "_"),
    for: yaml.valueText([...at, "for"]) ?? "",
    yaml: at,
    line: yaml.line(at),
    terminal: yaml.lineText([...at, "terminal"]),
    error: yaml.lineText([...at, "error"]),
    sets: yaml.lineText([...at, "sets"]),
    next: nextPaths(yaml, at).map((entry) => readNext(yaml, entry)),
  };
}

/** A default of behaviours, and the part of the specification that says it. */
export interface Default {
  text: string;
  of: "group" | "subsystem" | "agent" | "system";
}

/** `on_error` as it holds at a subsystem or agent; `around`: only what is said around it. */
export function onError({ yaml }: Structure, at: YamlPath, around = false): Default | undefined {
  const levels: { path: YamlPath; of: Default["of"] }[] = [{ path: [], of: "system" }];
  if (at.length >= 2) levels.unshift({ path: at.slice(0, 2), of: "agent" });
  if (at.length > 2) levels.unshift({ path: at, of: "subsystem" });
  for (const { path, of } of around ? levels.slice(1) : levels) {
    const text = yaml.valueText([...path, "on_error"]);
    if (text) return { text, of };
  }
  return undefined;
}

/** The list of a subsystem that behaviours without one of their own have. */
export function listAround({ yaml }: Structure, subsystem: Subsystem, key: "send" | "receive"): string {
  const text = yaml.lineText([...subsystem.yaml, key]);
  return text === "first" || text === "last" ? "" : text;
}

/** `on_error` of a group: without it, a failure leaves the group. */
function onErrorOf({ yaml }: Structure, group: Behaviour): Default | undefined {
  const text = yaml.valueText([...group.yaml, "on_error"]);
  return text ? { text, of: "group" } : undefined;
}

/** The behaviour to which `on_error` leads the failures of one that no entry of its `next` names. */
export function leadsFailures(structure: Structure, subsystem: Subsystem, behaviour: Behaviour): Default | undefined {
  const group = subsystem.behaviours.find((one) => one.path === behaviour.group);
  const found = group ? onErrorOf(structure, group) : onError(structure, subsystem.yaml);
  const isNamed = behaviour.next.some(({ when }) => when === "error");
  return !found || found.text === "stop" || found.text === behaviour.name || isNamed ? undefined : found;
}

/** The entries of `next` in the file: it is one entry, or a list of them. */
export function nextPaths(yaml: YamlText, behaviour: YamlPath): YamlPath[] {
  const at = [...behaviour, "next"];
  const node = yaml.node(at);
  if (!node || (isScalar(node) && node.value === null)) return [];
  return yaml.seq(at)?.items.map((_, index) => [...at, index]) ?? [at];
}

/** An entry is a name, or a map. */
function readNext(yaml: YamlText, at: YamlPath): Behaviour["next"][number] {
  const field = (path: YamlPath) => yaml.valueText(path) ?? "";
  if (!yaml.map(at)) return { to: field(at), when: "", sets: "" };
  return { to: field([...at, "to"]), when: field([...at, "when"]), sets: yaml.lineText([...at, "sets"]) };
}

function readChannel(yaml: YamlText, index: number): Channel {
  const at = ["channels", index];
  const line = yaml.line(at);
  const short = yaml.map(at) ? undefined : yaml.valueText(at);
  if (short !== undefined) {
    const [from = "", to = ""] = short.split("->").map((end) => end.trim());
    return { index, from, to, send: "non_blocking", receive: "non_blocking", timeout: "", model: "", line };
  }
  const field = (key: string) => yaml.valueText([...at, key]) ?? "";
  const mode = (key: string) => field(key) || "non_blocking";
  return {
    index,
    from: field("from"),
    to: field("to"),
    send: mode("send"),
    receive: mode("receive"),
    timeout: field("timeout"),
    model: field("model"),
    line,
  };
}

/** The channel of the specification that a channel of the net was made from: "a[2].x.y->b[3].z.u". */
export function channelOf(structure: Structure, name: string): Channel | undefined {
  const [from = "", to = ""] = name.split("->").map(withoutIndex);
  return structure.channels.find((one) => withoutIndex(one.from) === from && withoutIndex(one.to) === to);
}

/**
 * The element that a path names: `robot`, `robot.control`, `robot.control.follow`,
 * `channel:2`, `template:rover.control`, `input:robot.control.line`. A buffer is also found without its direction, if no
 * behaviour has its name.
 */
export function findThing(structure: Structure, selection: string): Thing | undefined {
  const path = selectedPath(selection);
  const direction = /^(input|output|real):/.exec(selection)?.[1] ?? "";
  if (path.startsWith("channel:")) {
    const of = structure.channels[Number(path.slice(8))];
    return of && { kind: "channel", of };
  }
  const [agentName, ...rest] = withoutIndex(path).split(".");
  const template = /^template:(.*)$/.exec(agentName ?? "")?.[1];
  const agent =
    template === undefined ? structure.agents.find((one) => one.name === agentName) : readTemplate(structure, template);
  if (!agent) return undefined;
  if (rest.length === 0) return { kind: template === undefined ? "agent" : "template", of: agent };
  const subsystem = agent.subsystems.find((one) => one.name === rest[0]);
  if (!subsystem) return undefined;
  if (rest.length === 1) return { kind: "subsystem", of: subsystem, agent };
  const inside = `${subsystem.path}.${rest.slice(1).join(".")}`;
  const behaviour = direction ? undefined : subsystem.behaviours.find((one) => one.path === inside);
  if (behaviour) return { kind: "behaviour", of: behaviour, subsystem };
  if (rest.length > 2) return undefined;
  const buffer = subsystem.buffers.find((one) => one.name === rest[1] && (!direction || one.direction === direction));
  return buffer && { kind: "buffer", of: buffer, subsystem };
}

/** The text that selects an element after paths in the file have changed: `moved` gives the present one of a path. */
export function selectionAfter(structure: Structure, selection: string, moved: (at: YamlPath) => YamlPath): string {
  const [direction = "", behind = ""] = selection.split(selectedPath(selection));
  const names = selectedPath(selection).split(".");
  const present = names.map((name, index) => {
    const part = names.slice(0, index + 1).join(".");
    const thing = findThing(structure, index === names.length - 1 ? direction + part + behind : part);
    if (!thing || thing.kind === "channel") return name;
    const [own] = /^template:/.exec(name) ?? [""];
    return `${own}${String(moved(thing.of.yaml).at(-1))}${/\[.*$/.exec(name)?.[0] ?? ""}`;
  });
  return direction + present.join(".") + behind;
}

/** The innermost element on a line. */
export function thingAt(structure: Structure, line: number): string | undefined {
  const channel = structure.channels.find((one) => one.line === line);
  if (channel) return channelPath(channel.index);
  for (const agent of structure.agents)
    for (const subsystem of agent.subsystems) {
      if (line < subsystem.line || line > subsystem.endLine) continue;
      return subsystem.behaviours.find((one) => one.line === line)?.path ?? subsystem.path;
    }
  return structure.agents.find((one) => one.line === line)?.name;
}
