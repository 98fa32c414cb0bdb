import type { Diagnostic } from "../protocol";
import type { YamlPath, YamlText } from "./yaml_text";

/**
 * The complaints about the value at a path, in one text; undefined: there are none. `own`: without those about the entries
 * of the map or list.
 */
export function problemAt(
  yaml: YamlText,
  complaints: readonly Pick<Diagnostic, "severity" | "message" | "line" | "column">[],
  at: YamlPath,
  own: boolean,
): string | undefined {
  const counted = complaints.filter(({ severity }) => severity === "error" || severity === "warning");
  if (counted.length === 0) return undefined;
  const range = yaml.range(at);
  if (!range) return undefined;
  const inside = own ? partsOf(yaml, at).flatMap((part) => [yaml.range(part) ?? []]) : [];
  const messages = counted
    .filter(({ line, column }) => {
      const offset = yaml.offset(line, column);
      // A text that ends too early has its complaint behind it.
      const within = ([from = 0, to = 0]: readonly number[]) => offset >= from && offset <= to;
      return within(range) && !inside.some(within);
    })
    .map(({ message }) => message);
  return messages.length > 0 ? messages.join("; ") : undefined;
}

const partsOf = (yaml: YamlText, at: YamlPath): YamlPath[] => [
  ...yaml.keys(at).map((key) => [...at, key]),
  ...(yaml.seq(at)?.items ?? []).map((_, index) => [...at, index]),
];
