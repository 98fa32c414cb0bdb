import type { Structure, Subsystem } from "../structure/structure";

/** A name that C++ may use at a place, as a completion offers it. */
export interface Member {
  name: string;
  kind: "value" | "function";
  /** Its type or meaning, in a few words. */
  detail: string;
}

const value = (name: string, detail: string): Member => ({ name, kind: "value", detail });
const call = (name: string, detail: string): Member => ({ name, kind: "function", detail });

/** Arguments of every transition function. */
const own = [
  value("in", "what it reads"),
  value("memory", "what it keeps"),
  value("out", "what it writes"),
  value("context", "time, parameters, log"),
];

/** `tessera/context.hpp`: a test compares. */
export const contextMembers: readonly Member[] = [
  value("parameters", "of the subsystem and the system"),
  value("now", "the time of this iteration"),
  value("period", "of its rate"),
  value("iteration", "counts all behaviours of the subsystem"),
  value("in_behaviour", "time since the behaviour began"),
  value("index", "of the agent in its fleet"),
  value("member", "for which the behaviour is"),
  call("log", 'writes a line: log("at {}", x)'),
  call("warn", "writes a warning"),
  call("stop", "ends the whole system safely"),
  call("emergency_stop", "gives every device its safe command"),
  call("assert_that", "states what must hold"),
];

/** The name of a type without its unit and length: "float64" of "float64[3] m". */
const bare = (type: string) => type.trim().replace(/[\s[].*$/, "");

/** The members that a transition function of a subsystem sees behind `in.line.`: path ["in", "line"]. */
export function cppMembers({ yaml, types }: Structure, subsystem: Subsystem, path: readonly string[]): Member[] {
  const [first, second, ...rest] = path;
  if (first === undefined) return own;
  if (first === "context") {
    if (second === undefined) return [...contextMembers];
    if (second !== "parameters" || rest.length > 0) return [];
    const names = [...yaml.keys([...subsystem.yaml, "parameters"]), ...yaml.keys(["parameters"])];
    return [...new Set(names)].map((name) => value(name, "parameter"));
  }
  const roots = rootsOf(first);
  const start = roots ?? [];
  if (second === undefined) return start;
  let type = start.find(({ name }) => name === second)?.detail ?? "";
  for (const field of rest) type = fieldsOf(type).find(({ name }) => name === field)?.detail ?? "";
  return fieldsOf(type);

  function rootsOf(name: string): Member[] | undefined {
    const real = { in: subsystem.kind === "receptor", out: subsystem.kind === "effector" } as Record<string, boolean>;
    const direction = { in: "input", out: "output" }[name];
    if (direction)
      return subsystem.buffers
        .filter((one) => one.direction === direction || (one.direction === "real" && real[name]))
        .map((one) => value(one.name, one.type));
    if (name !== "memory") return undefined;
    const at = [...subsystem.yaml, "memory"];
    return yaml.keys(at).map((one) => value(one, yaml.valueText([...at, one, "type"]) ?? yaml.valueText([...at, one]) ?? ""));
  }

  function fieldsOf(text: string): Member[] {
    const name = bare(text);
    if (!types.includes(name)) return [];
    return yaml.keys(["types", name]).map((one) => value(one, yaml.valueText(["types", name, one]) ?? ""));
  }
}

/** The path that ends at a position of a line: ["in", "line"] of "x = in.line.le"; null: none ends there. */
export function pathBefore(line: string): string[] | null {
  const found = /((?:[A-Za-z_]\w*(?:\[[^\]]*\])*\.)*)([A-Za-z_]\w*)?$/.exec(line);
  if (!found || (found[1] === "" && !found[2])) return null;
  return found[1]!
    .replace(/\[[^\]]*\]/g, "")
    .split(".")
    .filter(Boolean);
}
