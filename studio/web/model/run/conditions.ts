import { structureOf, withoutIndex, type Structure } from "../structure/structure";
import type { YamlPath } from "../text/yaml_text";

/** The named conditions of a behaviour: its name, and the expression in the specification. */
type Named = ReadonlyMap<string, string>;

const known = new WeakMap<Structure, Map<string, Named>>();

const shared = "conditions";

/** The expressions that a map of the file gives names to. */
const readNamed = ({ yaml }: Structure, at: YamlPath): [string, string][] =>
  yaml.map(at) ? yaml.keys(at).map((name) => [name, yaml.valueText([...at, name]) ?? name]) : [];

/** The names by path of the behaviour: of its `terminal` and `error`, and the `conditions` around it. */
function namedConditions(structure: Structure): Map<string, Named> {
  const all = new Map<string, Named>();
  for (const agent of structure.agents)
    for (const subsystem of agent.subsystems)
      for (const { path, yaml } of subsystem.behaviours) {
        const around = [[shared], [...agent.body, shared], [...subsystem.yaml, shared]];
        const places = [...around, [...yaml, "terminal"], [...yaml, "error"]];
        all.set(path, new Map(places.flatMap((at) => readNamed(structure, at))));
      }
  return all;
}

function namesAt(specification: string, behaviour: string): Named {
  const structure = structureOf(specification);
  let all = known.get(structure);
  if (!all) known.set(structure, (all = namedConditions(structure)));
  return all.get(withoutIndex(behaviour)) ?? new Map<string, string>();
}

/**
 * Conditions as the net has them, "full or over", with the expressions of the specification instead of their
 * names. A name whose expression is in an included file stays. `[i]` becomes the index of the behaviour.
 */
export function spelledOut(specification: string, behaviour: string, text: string): string {
  const named = namesAt(specification, behaviour);
  const parts = text.split(" or ").map((part) => named.get(part) ?? part);
  const index = /\[([^\][]+)\]$/.exec(behaviour)?.[1];
  const spelled =
    parts.length === 1 ? parts[0]! : parts.map((part) => (/ (or|\|\|) /.test(part) ? `(${part})` : part)).join(" or ");
  return index === undefined ? spelled : spelled.replaceAll("[i]", `[${index}]`);
}

/** The things that a condition reads: "memory.battery" and the like, each once. */
export function readIn(condition: string): string[] {
  const found = condition.match(/\b(?:memory|in|out|parameters)\.[A-Za-z_]\w*(?:\[\d+\]|\.[A-Za-z_]\w*)*/g) ?? [];
  return [...new Set(found)];
}

/** The path of its value among those of a run: "robot.control.memory.battery". */
export const valuePath = (subsystem: string, read: string): string => `${subsystem}.${read.replace(/^(in|out)\./, "")}`;
