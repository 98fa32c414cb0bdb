import { behavioursIn, leadsFailures, onError, type Behaviour, type Structure, type Subsystem } from "./structure";

/**
 * The state machine of a subsystem, or of one of its groups: behaviours as states, entries of `next` as arrows. Groups
 * have a machine of their own inside.
 */

/** States that are no behaviours: the beginning, the end, and the source of all failures that no entry names. */
export type Mark = "start" | "end" | "failures";
export const markPath = (level: string, mark: Mark) => `${level}#${mark}`;
export const markOf = (path: string): Mark | undefined => /#(start|end|failures)$/.exec(path)?.[1] as Mark | undefined;

export interface Arrow {
  /** Paths of behaviours or marks. */
  from: string;
  to: string;
  /** The condition under which it is taken; empty: it is always taken. */
  label: string;
  kind: "begin" | "next" | "failure";
  /** The entry of `next` of the behaviour `from`; null: no entry says so. */
  entry: number | null;
}
export interface Level {
  /** The path of the subsystem or group. */
  path: string;
  states: Behaviour[];
  marks: Mark[];
  arrows: Arrow[];
}

/** "lend[i+1]" leads to the behaviour lend, of the next member. */
const targetOf = (to: string) => {
  const [, name = to, index = ""] = /^([^[]*)\[([^\]]*)\]$/.exec(to.trim()) ?? [];
  return { name: name.trim(), index: index.trim() };
};

/** The names of terminal conditions, or the condition itself; empty: it goes on after one iteration. */
function terminalText(structure: Structure, { yaml: at, terminal }: Behaviour): string {
  const names = structure.yaml.keys([...at, "terminal"]);
  if (names.length > 0) return names.join(" or ");
  return terminal === "true" ? "" : terminal;
}

function labelOf(structure: Structure, behaviour: Behaviour, at: number): string {
  const { to, when } = behaviour.next[at]!;
  const { index } = targetOf(to);
  const of = index === "" || index === "i" || !behaviour.for ? "" : ` [${index}]`;
  const until = behaviour.isGroup ? structure.yaml.lineText([...behaviour.yaml, "until"]) : "";
  if (when === "error") return `error${behaviour.error ? `: ${behaviour.error}` : ""}${of}`;
  if (when === "until") return `until ${until}${of}`;
  if (when) return when + of;
  const isElse = behaviour.next.slice(0, at).some((one) => one.when !== "" && one.when !== "error");
  if (isElse) return `else${of}`;
  return (behaviour.isGroup ? "" : terminalText(structure, behaviour)) + of;
}

/** The machine of a subsystem, or of the group at a path. */
export function levelOf(structure: Structure, subsystem: Subsystem, group = ""): Level {
  const path = group || subsystem.path;
  const states = behavioursIn(subsystem, group);
  const arrows: Arrow[] = [];
  const marks = new Set<Mark>();
  const mark = (one: Mark) => (marks.add(one), markPath(path, one));
  const named = (name: string) => states.find((one) => one.name === name);
  const own = subsystem.behaviours.find((one) => one.path === group);
  const first = own ? structure.yaml.valueText([...own.yaml, "start"]) : subsystem.start;
  const start = named(targetOf(first ?? "").name) ?? states[0];
  if (start) arrows.push({ from: mark("start"), to: start.path, label: "", kind: "begin", entry: null });
  for (const state of states) {
    state.next.forEach(({ to, when }, entry) => {
      const { name } = targetOf(to);
      const target = name === "end" ? mark("end") : named(name)?.path;
      if (!target) return;
      const kind = when === "error" ? "failure" : "next";
      arrows.push({ from: state.path, to: target, label: labelOf(structure, state, entry), kind, entry });
    });
    if (state.next.length === 0 && !state.isGroup && state.terminal)
      arrows.push({ from: state.path, to: mark("end"), label: terminalText(structure, state), kind: "next", entry: null });
  }
  const failures = failuresOf(structure, subsystem, own, states);
  if (failures) {
    const target = named(targetOf(failures).name);
    if (target)
      arrows.push({ from: mark("failures"), to: target.path, label: "any other failure", kind: "failure", entry: null });
  }
  return { path, states, marks: [...marks], arrows };
}

/** The behaviour to which `on_error` leads; undefined: no failure is led by it. */
function failuresOf(structure: Structure, subsystem: Subsystem, group: Behaviour | undefined, states: readonly Behaviour[]) {
  if (!states.some((one) => leadsFailures(structure, subsystem, one))) return undefined;
  return group ? structure.yaml.valueText([...group.yaml, "on_error"]) : onError(structure, subsystem.yaml)?.text;
}
