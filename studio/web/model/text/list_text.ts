import { scalarText, type YamlPath, type YamlText } from "./yaml_text";

/** "[a, b]" in the form for typing: "a, b". A list of lists keeps its brackets. */
export const listAsTyped = (text: string) => text.replace(/^\[\s*(?!\[)(.*?)\s*\]$/s, "$1");

/** The parts between commas that are in no brackets and no quotes. */
function partsOf(text: string): string[] {
  const parts = [""];
  let [depth, quote] = [0, ""];
  for (const letter of text) {
    if (quote) quote = letter === quote ? "" : quote;
    else if (letter === '"' || letter === "'") quote = letter;
    else if ("([{".includes(letter)) depth += 1;
    else if (")]}".includes(letter)) depth -= 1;
    if (letter === "," && depth === 0 && !quote) parts.push("");
    else parts[parts.length - 1] += letter;
  }
  return parts.map((part) => part.trim()).filter(Boolean);
}

/** "a, b" in the form of the file; a single name is no list. */
export function listAsWritten(text: string, anchors: readonly string[] = []): string {
  const parts = partsOf(text);
  if (parts.length < 2) return scalarText(text, anchors);
  return `[${parts.map((part) => (/^(["']).*\1$/s.test(part) ? part : scalarText(part, anchors))).join(", ")}]`;
}

/** The value at a path as text for one field: a list in lines of its own as one line. */
export function lineText(yaml: YamlText, at: YamlPath): string {
  const list = yaml.seq(at);
  if (!list || list.flow) return yaml.valueText(at) ?? "";
  const items = list.items.map((_, index) => [...at, index]);
  return `[${items.map((one) => (yaml.isAlias(one) ? yaml.valueText(one) : scalarText(lineText(yaml, one)))).join(", ")}]`;
}
