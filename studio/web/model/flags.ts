import type { NetModel } from "./net";

interface Complaint {
  severity: "error" | "warning" | "hint" | "note";
  line: number;
}

/** The pages to mark for complaints: the innermost page that begins on the line, or last before it. */
export function flagsOf(net: NetModel, complaints: readonly Complaint[]): Map<string, "error" | "warning"> {
  const flags = new Map<string, "error" | "warning">();
  for (const { severity, line } of complaints) {
    if (severity !== "error" && severity !== "warning") continue;
    for (const path of pagesAt(net, line)) if (severity === "error" || !flags.has(path)) flags.set(path, severity);
  }
  return flags;
}

function pagesAt(net: NetModel, line: number): string[] {
  const shown = net.pages.filter((page) => page.layer !== "communication" && page.span.line > 0 && page.span.line <= line);
  const nearest = Math.max(0, ...shown.map((page) => page.span.line));
  const begun = shown.filter((page) => page.span.line === nearest);
  const deepest = Math.max(0, ...begun.map((page) => page.path.split(".").length));
  return begun.filter((page) => page.path.split(".").length === deepest).map((page) => page.path);
}
