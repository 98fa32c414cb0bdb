import type { YamlPath, YamlText } from "./yaml_text";

/** The text of an entry of a map with its key and the comments above it, as if it stood alone; empty: it is not there. */
export function elementText(yaml: YamlText, at: YamlPath): string {
  const range = yaml.range(at);
  if (!range) return "";
  const { text } = yaml;
  const [from, to] = range;
  const start = text.lastIndexOf("\n", from - 1) + 1;
  const indent = text.slice(start, from);
  // In one line with others: { a: {}, b: {} }.
  if (indent.trim() !== "") return `${text.slice(from, to)}\n`;
  let first = start;
  while (first > 0) {
    const above = text.lastIndexOf("\n", first - 2) + 1;
    if (!text.slice(above, first).startsWith(`${indent}#`)) break;
    first = above;
  }
  const end = text.indexOf("\n", to);
  const lines = text.slice(first, end < 0 ? text.length : end).split("\n");
  return `${lines.map((line) => (line.startsWith(indent) ? line.slice(indent.length) : line.trimStart())).join("\n")}\n`;
}
