import type { YamlPath, YamlText } from "./yaml_text";

/** "[a, b]" in the form for typing: "a, b". A list of lists keeps its brackets. */
export const listAsTyped = (text: string) => text.replace(/^\[\s*(?!\[)(.*?)\s*\]$/s, "$1");

/** An item of a list in one line: in quotes if its text would be read otherwise there. */
const itemText = (text: string) => (/^[[{]/.test(text) || /^[\w./+-][^,[\]{}#:"']*$/.test(text) ? text : JSON.stringify(text));

/** The value at a path as text for one field: a list in lines of its own as one line. */
export function lineText(yaml: YamlText, at: YamlPath): string {
  const list = yaml.seq(at);
  if (!list || list.flow) return yaml.valueText(at) ?? "";
  const items = list.items.map((_, index) => [...at, index]);
  return `[${items.map((one) => (yaml.isAlias(one) ? yaml.valueText(one) : itemText(lineText(yaml, one)))).join(", ")}]`;
}
