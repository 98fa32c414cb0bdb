import type { NetModel } from "./net/net";
import type { Diagnostic } from "./protocol";

/** The pages to mark for complaints: the innermost page that begins on the line, or last before it. */
export function flagsOf(
  net: NetModel,
  complaints: readonly Pick<Diagnostic, "severity" | "line">[],
): Map<string, "error" | "warning"> {
  const flags = new Map<string, "error" | "warning">();
  for (const { severity, line } of complaints) {
    if (severity !== "error" && severity !== "warning") continue;
    for (const path of pagesAt(net, line)) if (severity === "error" || !flags.has(path)) flags.set(path, severity);
  }
  return flags;
}

function pagesAt(net: NetModel, line: number): string[] {
  const shown = net.elements.pagesOfEachKind().filter((index) => {
    const { layer, span } = net.page(index);
    return layer !== "communication" && span.line > 0 && span.line <= line;
  });
  const nearest = Math.max(0, ...shown.map((index) => net.page(index).span.line));
  const begun = shown.filter((index) => net.page(index).span.line === nearest);
  const deepest = Math.max(0, ...begun.map((index) => net.ancestry(index).length));
  return begun
    .filter((index) => net.ancestry(index).length === deepest)
    .flatMap((index) => net.elements.twins(index).map((twin) => net.page(twin).path));
}
