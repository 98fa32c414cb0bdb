const name = String.raw`[+-]?[A-Za-z_]\w*(?:\[[^\[\],"']*\])?`;
const item = new RegExp(`^(?:"${name}"|'${name}'|${name})$`);

/**
 * The YAML of a list of names that was typed as words: `a, b[i]` and `[a, b[i]]` become `[a, "b[i]"]`, because an index
 * needs quotes in YAML. Any other text stays as it is.
 */
export function nameList(text: string): string {
  const trimmed = text.trim();
  const names = trimmed
    .replace(/^\[(.*)\]$/, "$1")
    .split(",")
    .map((one) => one.trim());
  if (!names.every((one) => item.test(one))) return text;
  return `[${names
    .map((one) => one.replace(/["']/g, ""))
    .map((one) => (one.includes("[") ? `"${one}"` : one))
    .join(", ")}]`;
}
