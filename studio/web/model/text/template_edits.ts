import type { Agent, Structure } from "../structure/structure";
import { apply } from "./yaml_text";

/**
 * Moves the subsystems of an agent to a template of the same name, so that a fleet can have them, and their C++ keeps its
 * namespace. null: the text would have to be laid out anew, or has anchors and aliases, whose order counts.
 */
export function makeTemplate(structure: Structure, agent: Agent): string | null {
  const { yaml } = structure;
  const range = yaml.range(agent.yaml);
  if (agent.template || !range || yaml.map(agent.yaml)?.flow || yaml.pair(["templates", agent.name])) return null;
  const column = (at: number) => at - (yaml.text.lastIndexOf("\n", at - 1) + 1);
  const [beside = ""] = yaml.keys(["templates"]);
  const indent = yaml.range(["templates", beside]);
  if (yaml.pair(["templates"]) && (!indent || yaml.map(["templates"])?.flow)) return null;
  if (column(range[0]) !== (indent ? column(indent[0]) : 2)) return null;
  // A comment behind the last value goes along.
  const line = yaml.text.indexOf("\n", range[1] - 1);
  const end = line < 0 ? yaml.text.length : line;
  const entry = yaml.text.slice(range[0], end);
  const body = entry.slice(entry.indexOf(":") + 1);
  if (/(^|[\s[{,:])[&*][\w-]+/m.test(body.replace(/"[^"]*"|'[^']*'|(^|\s)#.*$/gm, ""))) return null;
  return apply(yaml.text, [
    ...yaml.insert(["templates"], agent.name, body.trimEnd()).map((edit) => ({
      ...edit,
      insert: edit.insert.replace(`${agent.name}: ${body.trimEnd()}`, () => `${agent.name}:${body.trimEnd()}`),
    })),
    { from: range[0], to: end, insert: `${agent.name}: { use: ${agent.name} }` },
  ]);
}
